#include "compiler/face_samples.h"
