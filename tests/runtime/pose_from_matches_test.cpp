#include "runtime/pose_from_matches.h"

#include <gtest/gtest.h>
