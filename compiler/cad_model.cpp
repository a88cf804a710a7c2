#include "compiler/cad_model.h"
