#include "compiler/report.h"
