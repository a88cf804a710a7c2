// Names the objects of a database, and looks for them in a scan of an empty wall.
//
//   workcell [DATABASE]     without it: the database in the program itself
#include <cstddef>
#include <iostream>
#include <string>
#include <vector>

#include <foresight/errors.h>
#include <foresight/foresight.h>

#include "parts_database.h"

namespace {

foresight::Recognizer load(int argc, char** argv) {
  if (argc > 1) return foresight::Recognizer(argv[1]);
  return foresight::Recognizer(foresight::DatabaseBytes{parts_database, parts_database_size});
}

// A pinhole camera of 512 cells focal length looks at a wall 900 mm away.
std::vector<float> wall(int rows, int columns) {
  std::vector<float> xyz;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const float x = 900.0F * (static_cast<float>(column) - 31.5F) / 512.0F;
      const float y = 900.0F * (static_cast<float>(row) - 31.5F) / 512.0F;
      xyz.insert(xyz.end(), {x, y, 900.0F});
    }
  }
  return xyz;
}

}  // namespace

int main(int argc, char** argv) try {
  const foresight::Recognizer recognizer = load(argc, argv);
  for (const std::string& name : recognizer.object_names()) std::cout << name << "\n";
  const std::vector<float> scan = wall(64, 64);
  const foresight::RecognitionResult result = recognizer.recognize({64, 64, scan.data()});
  std::cout << result.statistics.regions << " region, " << result.detections.size() << " objects\n";
  return 0;
} catch (const foresight::Error& error) {
  std::cerr << "workcell: " << error.what() << "\n";
  return error.exit_code();
}
