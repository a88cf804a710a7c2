#include "schema/container.h"

#include <gtest/gtest.h>
