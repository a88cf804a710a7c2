// How to use the library from C++: this file includes runtime/foresight.h alone, links foresight_runtime alone, and
// recognizes a scan that it has read itself.
//
//   api_example DATABASE SCAN.pcd    (an organized PCD in ascii, fields x y z, mm)
//
// Prints the detections: object, position, quaternion, and how far position and turn may be off. Ends with the exit
// codes of the programs.
#include <cmath>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <future>
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

// Standard deviation along the axis that is known worst: at most this. Rows first to first + 2 of the covariance.
double deviation(const std::array<double, 36>& covariance, std::size_t first) {
  double trace = 0.0;
  for (std::size_t i = first; i < first + 3; ++i) trace += covariance[7 * i];
  return std::sqrt(trace);
}

void print(const foresight::Detection& found) {
  std::cout << found.object;
  for (const std::size_t i : {3U, 7U, 11U}) std::cout << " " << found.T_sensor_model[i];
  for (const double number : found.quaternion) std::cout << " " << number;
  std::cout << " +-" << deviation(found.covariance, 0) << " mm +-" << deviation(found.covariance, 3) << " rad\n";
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) return 2;
  // Load once.
  const std::shared_ptr<const foresight::Database> database = foresight::load_shared_database(argv[1]);
  const Points points = read_ascii_pcd(argv[2]);
  if (points.xyz.size() != 3U * static_cast<std::size_t>(points.rows) * static_cast<std::size_t>(points.columns))
    return 3;

  // A recognizer for each thread. Both see the same scan here, and give the same bits.
  const auto recognize = [&] {
    const foresight::Recognizer recognizer(database);
    return recognizer.recognize({points.rows, points.columns, points.xyz.data()},
                                std::chrono::minutes(1));  // the deadline may be left out
  };
  std::future<foresight::RecognitionResult> other = std::async(std::launch::async, recognize);
  const foresight::RecognitionResult result = recognize();
  if (other.get().detections.size() != result.detections.size()) return 70;

  for (const foresight::Detection& found : result.detections) print(found);
  if (!result.complete) return 5;
  return result.detections.empty() ? 1 : 0;
} catch (const std::exception& error) {  // what the constructors and recognize() throw says what to do
  std::cerr << error.what() << "\n";
  return 3;
}
