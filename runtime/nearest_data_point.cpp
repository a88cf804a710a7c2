#include "runtime/nearest_data_point.h"
