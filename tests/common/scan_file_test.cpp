#include "common/scan_file.h"

#include <gtest/gtest.h>
