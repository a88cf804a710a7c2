#include "runtime/pose_file.h"
