#include "compiler/face_samples.h"

#include <gtest/gtest.h>
