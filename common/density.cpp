#include "common/density.h"
