#include "runtime/highest_confidence_first.h"
