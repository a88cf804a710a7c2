#include "runtime/hypothesis_cliques.h"
