#include "compiler/scene_generator.h"

#include <gtest/gtest.h>
