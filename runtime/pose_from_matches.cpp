#include "runtime/pose_from_matches.h"
