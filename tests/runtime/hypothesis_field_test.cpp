#include "runtime/hypothesis_field.h"

#include <gtest/gtest.h>
