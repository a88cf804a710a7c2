#include "compiler/database_writer.h"

#include <gtest/gtest.h>
