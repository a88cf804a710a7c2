#include "compiler/statistics.h"
