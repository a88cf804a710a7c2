#include "runtime/result_writer.h"
