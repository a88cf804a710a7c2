#include "schema/container.h"
