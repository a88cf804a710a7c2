// Compiles with the source root as the only include folder: the public header needs nothing but the standard library.
#include "runtime/foresight.h"

int use(const foresight::Recognizer& recognizer, const foresight::RangeImageView& view) {
  const foresight::RecognitionResult result = recognizer.recognize(view, std::chrono::milliseconds(100));
  return result.complete ? static_cast<int>(result.detections.size()) : -1;
}
