#include "compiler/surface_template.h"
