#include "runtime/robust_loss.h"
