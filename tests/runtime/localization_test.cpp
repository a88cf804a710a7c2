#include "runtime/localization.h"

#include <gtest/gtest.h>
