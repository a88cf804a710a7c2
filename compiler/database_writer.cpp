#include "compiler/database_writer.h"
