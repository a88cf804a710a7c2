#include "compiler/sensor_simulator.h"
