#include "runtime/hypothesis_cliques.h"

#include <gtest/gtest.h>
