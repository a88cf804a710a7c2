/* Compiles as C99, C11 and C++ with the source root as the only include folder: the C header needs <stdint.h> only. */
#include "runtime/foresight_c.h"

int use(const foresight_recognizer* recognizer, foresight_result* result, const float* xyz);

int use(const foresight_recognizer* recognizer, foresight_result* result, const float* xyz) {
  const foresight_options options = FORESIGHT_OPTIONS_DEFAULT;
  foresight_image image;
  image.size = sizeof image;
  image.rows = image.columns = 64;
  image.reserved = options.reserved;
  image.xyz = xyz;
  return foresight_recognize(recognizer, &image, FORESIGHT_NO_DEADLINE, result);
}
