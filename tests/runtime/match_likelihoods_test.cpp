#include "runtime/match_likelihoods.h"

#include <gtest/gtest.h>
