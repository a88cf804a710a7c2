#include "runtime/database.h"
