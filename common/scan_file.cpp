#include "common/scan_file.h"
