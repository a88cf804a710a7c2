#include "runtime/localization.h"
