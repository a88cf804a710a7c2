#include "runtime/verification.h"
