#include "runtime/recognize.h"
