// What is found, as it is reported.
#pragma once

#include <array>
#include <vector>

#include "common/camera.h"
#include "common/range_image.h"
#include "common/sensor_model.h"
#include "runtime/database.h"
#include "runtime/foresight.h"
#include "runtime/recognition.h"

namespace foresight {

// A reported T_sensor_model, row by row, and back.
[[nodiscard]] Pose pose_of(const std::array<double, 16>& T);
[[nodiscard]] std::array<double, 16> row_major(const Pose& pose);

// Of the CAD model's vertices, along the model's axes. Unit: mm.
struct BoundingBox {
  std::array<double, 3> centre{};
  std::array<double, 3> size{};
};
[[nodiscard]] BoundingBox bounding_box(const CompiledModel& model);

// A refined pose as a detection: pose, box, fractions and score; no rank, faces, regions or covariance yet.
[[nodiscard]] Detection to_detection(const CompiledModel& model, const RefinedPose& refined);

// As Detection::covariance, of a model at a pose in an image. sensor: its noise.
[[nodiscard]] std::array<double, 36> covariance_at(const CompiledModel& model, const Pose& T_sensor_model,
                                                   const RangeImage& image, const PinholeCamera& camera,
                                                   const SensorModel& sensor);

// Entries of results that are not needed now; their lists and names keep their memory for the next scan.
struct SpareDetections {
  std::vector<Detection> detections;
  std::vector<Alternative> alternatives;
};

// Enough for usual scenes, so that no first detection of its kind asks the heap for memory.
[[nodiscard]] SpareDetections spare_detections(const Database& database);

// Takes back what the result holds.
void empty(RecognitionResult& result, SpareDetections& spare);

// What was found, in place of what the result holds. Allocates only what neither the result nor the spare has.
void report(const Recognition& found, const Database& database, RecognitionResult& result, SpareDetections& spare);

}  // namespace foresight
