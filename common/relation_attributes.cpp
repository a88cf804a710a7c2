#include "common/relation_attributes.h"
