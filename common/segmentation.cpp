#include "common/segmentation.h"
