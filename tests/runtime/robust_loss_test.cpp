#include "runtime/robust_loss.h"

#include <gtest/gtest.h>
