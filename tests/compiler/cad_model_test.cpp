#include "compiler/cad_model.h"

#include <gtest/gtest.h>
