#include "compiler/surface_template.h"

#include <gtest/gtest.h>
