#include "compiler/scene_generator.h"
