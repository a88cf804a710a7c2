#include "runtime/foresight.h"
