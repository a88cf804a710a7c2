#include "runtime/match_likelihoods.h"
