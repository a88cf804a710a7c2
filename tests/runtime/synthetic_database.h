// Small databases built in code, no two numbers alike, for tests of writing, reading and looking up.
#pragma once

#include <cmath>
#include <string>

#include "common/compiled_model.h"

namespace foresight::test {

// Three bins that sum to 1; `seed` moves mass from the last to the first.
inline Density synthetic_density(double lower, double bin_width, int first_bin, float seed) {
  Density density;
  density.lower = lower;
  density.bin_width = bin_width;
  density.first_bin = first_bin;
  density.mass = {0.25F + seed, 0.5F, 0.25F - seed};
  return density;
}

// A model of four faces: 0, 1 and 3 were found, 0-1 and 0-3 and 1-3 together; face 2 never. `scale` is a length in mm.
inline CompiledModel synthetic_model(const std::string& name, double scale) {
  CompiledModel model;
  model.name = name;
  model.cad_file = name + ".obj";
  model.cad_sha256 = std::string(32, 'a') + std::string(32, '0');
  model.cad_unit = "in";
  model.diameter = scale;
  model.centre = {0.1 * scale, -0.2 * scale, 0.3 * scale};
  model.views = 320;
  for (int i = 0; i < 4; ++i) {
    ModelFace face;
    face.normal = Eigen::Vector3d(1.0, 0.5 * i, -0.1 * i * i).normalized();
    face.offset = 0.1 * scale + i;
    face.centroid = {1.0 * i, 2.5 * i, -scale};
    face.area = scale * (i + 1) / 3.0;
    face.views_found = i == 2 ? 0 : 60 + 10 * i;
    for (int k = 0; k < kAttributeCount && i != 2; ++k)
      face.densities[static_cast<std::size_t>(k)] =
          synthetic_density(0.5 * k, scale * (k + 1) / 24.0, 5 * i + k - 1, 0.01F * static_cast<float>(i));
    model.faces.push_back(face);
  }
  for (const auto& [first, second] : {std::pair(0, 1), std::pair(0, 3), std::pair(1, 3)}) {
    FacePair pair{first, second, 10 * first + second, {}};
    pair.densities[kOrientation] = synthetic_density(0.0, 3.2 / 24.0, 3 * first, 0.02F);
    pair.densities[kMaxDistance] = synthetic_density(0.0, scale / 24.0, 3 * second, 0.03F);
    model.pairs.push_back(pair);
  }
  model.acceptance = {{4.5, -3.25, -1.75, -0.5 * scale, 2.125, 0.6875, -1.25}, -0.375, 0.4, 0.03125, 77};
  model.symmetries = {{{rotation_from_vector({0.0, 0.0, 2.0}), {0.5 * scale, -7.0, 0.25}}, true, 1.0},
                      {{rotation_from_vector({1.5, -0.5, 0.125}), {-scale, 3.5, 11.0}}, false, 0.8125}};
  const auto length = static_cast<float>(scale);
  model.surface.spacing = 5.5;
  model.surface.points = {{{0.0F, 0.1F, length}, {0.0F, 0.0F, 1.0F}, {0}, {1, 2}},
                          {{1.0F, 0.2F, length}, {0.0F, 0.6F, 0.8F}, {0, 2, 3}, {0}},
                          {{2.0F, 0.3F, length}, {-1.0F, 0.0F, 0.0F}, {3}, {0}},
                          {{3.0F, 0.4F, -length}, {0.0F, -1.0F, 0.0F}, {1}, {}}};
  for (int cell = 0; cell < kAspectCells; ++cell)
    for (int face = cell % 5; face < 4; face += 2)
      model.surface.aspects[static_cast<std::size_t>(cell)].push_back(face);
  model.vertices = {{0.0F, 0.0F, 0.0F}, {length, 0.0F, 0.5F}, {0.0F, length, 0.25F}, {0.0F, 0.0F, length}};
  model.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  model.triangle_faces = {3, 0, 2, 1};
  GoldenScan& golden = model.golden_scan.emplace();
  golden.first_row = 10;
  golden.first_column = 20;
  golden.rows = 2;
  golden.columns = 3;
  golden.depth_step = 0.375;
  // Differences of order 3. A cell without data (100001), four with them (100100): 10, 9, 11 and 8 steps where 0, 10, 9
  // and 11 are promised (011100, 1001, 1100, 1101); then one without (100001) and none with data (100000).
  golden.depths = {3, '\x86', '\x47', '\x27', '\x36', '\x18', '\0'};
  golden.T_sensor_model = {rotation_from_vector({-0.25, 1.0, 0.5}), {scale, -2.5, 900.0}};
  return model;
}

inline CompiledDatabase synthetic_database() {
  CompiledDatabase database;
  database.tool_version = "0.1.0";
  database.ray_isa = "sse4.2";
  database.sensor.name = "synthetic";
  database.sensor.camera = {128, 256, 600.25, 700.5, 127.0, 63.0};
  database.sensor.projector = Eigen::Vector3d(250.0, -1.0, 7.0);
  database.sensor.nearest_distance = 800.0;
  database.sensor.farthest_distance = 1001.0;
  database.sensor.depth_quantization = 0.3;
  database.sensor.depth_noise = 0.7;
  database.sensor.largest_incidence = 1.2345678901234567;
  database.sensor.background = true;
  database.sensor.matching_window = 5;
  database.segmentation.plane_sigma = 0.37;
  database.segmentation.merge_tolerance = 1.75;
  database.segmentation.grow_tolerance = 2.5;
  database.segmentation.seed_block = 4;
  database.segmentation.smallest_region = 17;
  database.segmentation.largest_depth_step = 5.5;
  database.density.bins = 24;
  database.density.kernel = 0.75;
  database.models = {synthetic_model("castle", 100.0), synthetic_model("t\xC3\xBCrme", 250.0)};
  return database;
}

}  // namespace foresight::test
