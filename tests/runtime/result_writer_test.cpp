#include "runtime/result_writer.h"

#include <gtest/gtest.h>
