#include "runtime/hypothesis_field.h"
