#include "common/region_attributes.h"
