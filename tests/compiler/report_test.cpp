#include "compiler/report.h"

#include <gtest/gtest.h>
