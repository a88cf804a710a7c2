#include "compiler/sensor_file.h"
