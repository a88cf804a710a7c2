// A program of a user of the library: it includes runtime/foresight.h alone, links foresight_runtime alone, and
// recognizes a scan it has read itself.
//
//   api_example DATABASE SCAN.pcd    (an organized PCD in ascii, fields x y z, mm)
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "runtime/foresight.h"

namespace {

struct Points {
  int rows = 0;
  int columns = 0;
  std::vector<float> xyz;
};

Points read_ascii_pcd(const std::string& file) {
  std::ifstream in(file);
  Points points;
  std::string word;
  while (in >> word && word != "DATA") {
    if (word == "WIDTH") in >> points.columns;
    if (word == "HEIGHT") in >> points.rows;
  }
  in >> word;                                                                   // "ascii"
  while (in >> word) points.xyz.push_back(std::strtof(word.c_str(), nullptr));  // strtof takes "nan" too
  return points;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) return 2;
  const foresight::Recognizer recognizer(argv[1]);
  const Points points = read_ascii_pcd(argv[2]);
  if (points.xyz.size() != 3U * static_cast<std::size_t>(points.rows) * static_cast<std::size_t>(points.columns))
    return 3;
  const foresight::RecognitionResult result = recognizer.recognize({points.rows, points.columns, points.xyz.data()});
  for (const foresight::Detection& found : result.detections) {
    std::cout << found.object << " " << found.T_sensor_model[3] << " " << found.T_sensor_model[7] << " "
              << found.T_sensor_model[11] << "\n";
  }
  return result.detections.empty() ? 1 : 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 3;
}
