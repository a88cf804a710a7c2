#include "compiler/sensor_simulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <thread>

#include "runtime/rendering.h"
#include "tests/compiler/solids.h"
#include "tests/support.h"

namespace foresight {
namespace {

using Eigen::Vector3d;
using test::angle_block;
using test::box;
using test::wedge;

// Small, exact and cheap; tests add what they are about.
SensorModel exact_sensor() {
  SensorModel sensor;
  sensor.camera = {60, 64, 190.0, 195.0, 31.0, 30.0};
  sensor.depth_quantization = 0.0;
  return sensor;
}

Pose at(const Vector3d& translation) { return {Eigen::Matrix3d::Identity(), translation}; }

// Some general view of a model.
Pose some_view(std::uint64_t index, double distance = 900.0) {
  Random random(7, index);
  const Vector3d direction = random.direction();
  return view_pose(direction, Vector3d(30, 30, 20), distance, random.uniform(0.0, 6.0));
}

bool same_bits(const SimulatedScan& a, const SimulatedScan& b) {
  const auto same_label = [](const CellLabel& p, const CellLabel& q) {
    return p.object == q.object && p.face == q.face;
  };
  return a.image.points.size() == b.image.points.size() &&
         std::memcmp(a.image.points.data(), b.image.points.data(), a.image.points.size() * sizeof(Eigen::Vector3f)) ==
             0 &&
         std::equal(a.labels.begin(), a.labels.end(), b.labels.begin(), same_label);
}

int labelled(const SimulatedScan& scan) {
  return static_cast<int>(
      std::count_if(scan.labels.begin(), scan.labels.end(), [](const CellLabel& label) { return label.object >= 0; }));
}

TEST(SensorSimulator, face_towards_the_sensor_has_one_depth) {
  SensorModel sensor = exact_sensor();
  sensor.depth_quantization = 0.1;
  const CadModel model = box(200, 200, 50);
  const PlacedObject object{&model, at({-100, -100, 877.77})};
  const SimulatedScan scan = SimulatedScene({&object, 1}).scan(sensor, Random(1));
  ASSERT_GT(count_valid(scan.image), 1000);
  for (int cell = 0; cell < scan.image.size(); ++cell) {
    if (!scan.image.valid(cell)) continue;
    EXPECT_NEAR(scan.image[cell].z(), 877.77, 0.05 + 1e-4);
    EXPECT_NEAR(std::remainder(static_cast<double>(scan.image[cell].z()), 0.1), 0.0, 1e-4);
  }
}

TEST(SensorSimulator, covers_exactly_the_cells_whose_rays_meet_the_face) {
  const SensorModel sensor = exact_sensor();
  const CadModel model = box(101, 77, 10);
  const PlacedObject object{&model, at({-40, -30, 900})};
  const SimulatedScan scan = SimulatedScene({&object, 1}).scan(sensor, Random(1));
  for (int row = 0; row < sensor.camera.rows; ++row) {
    for (int column = 0; column < sensor.camera.columns; ++column) {
      const Vector3d p = 900.0 * sensor.camera.ray(row, column);
      const bool meets = p.x() > -40 && p.x() < 61 && p.y() > -30 && p.y() < 47;
      EXPECT_EQ(scan.image.valid(scan.image.cell(row, column)), meets) << row << " " << column;
    }
  }
}

TEST(SensorSimulator, points_lie_on_the_plane_of_their_labelled_face_and_on_their_ray) {
  const SensorModel sensor = exact_sensor();
  for (const CadModel& model : {box(90, 60, 40), angle_block(), wedge()}) {
    for (std::uint64_t view = 0; view < 20; ++view) {
      const PlacedObject object{&model, some_view(view)};
      const SimulatedScan scan = SimulatedScene({&object, 1}).scan(sensor, Random(1));
      ASSERT_GT(count_valid(scan.image), 50);
      for (int cell = 0; cell < scan.image.size(); ++cell) {
        const CellLabel label = scan.labels[static_cast<std::size_t>(cell)];
        ASSERT_EQ(scan.image.valid(cell), label.object == 0);
        if (!scan.image.valid(cell)) continue;
        const CadFace& face = model.faces[static_cast<std::size_t>(label.face)];
        const Vector3d sensor_point = scan.image[cell].cast<double>();
        const Vector3d point = object.T_sensor_model.inverse() * sensor_point;
        EXPECT_NEAR(face.normal.dot(point), face.offset, 1e-3);
        EXPECT_EQ(sensor.camera.cell_of(sensor_point), cell);
      }
    }
  }
}

TEST(SensorSimulator, nearer_of_two_objects_is_seen) {
  const CadModel model = box(60, 60, 10);
  const PlacedObject objects[] = {{&model, at({-30, -30, 950})}, {&model, at({-30, -30, 880})}};
  const SimulatedScan scan = SimulatedScene(objects).scan(exact_sensor(), Random(1));
  const CellLabel middle = scan.labels[static_cast<std::size_t>(scan.image.cell(30, 31))];
  EXPECT_EQ(middle.object, 1);
  EXPECT_EQ(middle.face, 0);  // the bottom of the prism looks along -z, at the sensor
}

TEST(SensorSimulator, same_seed_gives_the_same_bits_in_any_thread) {
  SensorModel sensor = exact_sensor();
  sensor.depth_noise = 0.5;
  sensor.projector = Vector3d(300, 0, 0);
  const CadModel model = angle_block();
  const auto simulate = [&](std::uint64_t view) {
    const PlacedObject object{&model, some_view(view)};
    const BackgroundPlane backdrop{Vector3d(0, 0, -1), -1000};
    return SimulatedScene({&object, 1}, {&backdrop, 1}).scan(sensor, Random(5, view));
  };
  std::vector<SimulatedScan> alone;
  for (std::uint64_t view = 0; view < 16; ++view) alone.push_back(simulate(view));
  std::vector<SimulatedScan> together(16);
  std::vector<std::thread> threads;
  for (std::uint64_t first = 0; first < 4; ++first) {
    threads.emplace_back([&, first] {
      for (std::uint64_t view = first; view < 16; view += 4) together[view] = simulate(view);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t view = 0; view < 16; ++view) EXPECT_TRUE(same_bits(alone[view], together[view])) << view;
  EXPECT_FALSE(same_bits(alone[0], alone[1]));
}

TEST(SensorSimulator, noise_has_the_stated_deviation_and_depends_on_the_seed) {
  SensorModel sensor = exact_sensor();
  sensor.depth_noise = 0.7;
  const BackgroundPlane wall{Vector3d(0, 0, -1), -900};
  const SimulatedScene scene({}, {&wall, 1});
  const SimulatedScan scan = scene.scan(sensor, Random(3));
  const int cells = scan.image.size();
  ASSERT_EQ(count_valid(scan.image), cells);
  double sum = 0.0;
  double squares = 0.0;
  for (const auto& point : scan.image.points) {
    const double error = static_cast<double>(point.z()) - 900.0;
    sum += error;
    squares += error * error;
  }
  EXPECT_NEAR(sum / cells, 0.0, 5.0 * 0.7 / std::sqrt(cells));
  EXPECT_NEAR(std::sqrt(squares / cells), 0.7, 5.0 * 0.7 / std::sqrt(2.0 * cells));
  EXPECT_TRUE(same_bits(scan, scene.scan(sensor, Random(3))));
  EXPECT_FALSE(same_bits(scan, scene.scan(sensor, Random(4))));
}

// Errors of neighbours along rows, as a share of the variance, for a flat wall.
double correlation(const RangeImage& image, int lag) {
  double products = 0.0;
  double squares = 0.0;
  int pairs = 0;
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column + lag < image.columns; ++column, ++pairs) {
      const double error = static_cast<double>(image[image.cell(row, column)].z()) - 900.0;
      products += error * (static_cast<double>(image[image.cell(row, column + lag)].z()) - 900.0);
      squares += error * error;
    }
  }
  return pairs == 0 ? 0.0 : products / squares;
}

TEST(SensorSimulator, cells_of_one_matching_window_err_alike) {
  SensorModel sensor = exact_sensor();
  sensor.camera = {200, 300, 400, 400, 149.5, 99.5};
  sensor.depth_noise = 0.7;
  const BackgroundPlane wall{Vector3d(0, 0, -1), -900};
  const SimulatedScene scene({}, {&wall, 1});
  for (const int window : {1, 5, 9}) {
    sensor.matching_window = window;
    const RangeImage image = scene.scan(sensor, Random(3)).image;
    double squares = 0.0;
    for (const auto& point : image.points) squares += std::pow(static_cast<double>(point.z()) - 900.0, 2);
    EXPECT_NEAR(std::sqrt(squares / image.size()), 0.7, 0.07) << window;
    for (const int lag : {1, 2, 4, 12}) {
      EXPECT_NEAR(correlation(image, lag), std::max(0.0, 1.0 - static_cast<double>(lag) / window), 0.12)
          << window << " " << lag;
    }
  }
}

TEST(SensorSimulator, matching_windows_leave_planes_and_make_ramps_of_steps) {
  SensorModel sensor = exact_sensor();
  const CadModel model = box(60, 60, 10);
  const PlacedObject object{&model, at({-30, -30, 900})};
  const BackgroundPlane wall{Vector3d(0.3, 0, -1).normalized(), -1000};
  const SimulatedScene scene({&object, 1}, {&wall, 1});
  const SimulatedScan sharp = scene.scan(sensor, Random(3));
  sensor.matching_window = 5;
  const SimulatedScan smooth = scene.scan(sensor, Random(3));
  int unlike = 0;
  for (int row = 0; row < sharp.image.rows; ++row) {
    for (int column = 0; column < sharp.image.columns; ++column) {
      const int cell = sharp.image.cell(row, column);
      const auto at_cell = static_cast<std::size_t>(cell);
      EXPECT_EQ(sharp.image.valid(cell), smooth.image.valid(cell));
      EXPECT_EQ(sharp.labels[at_cell].face, smooth.labels[at_cell].face);
      if (!sharp.image.valid(cell) || row < 2 || column < 2 || row + 2 >= sharp.image.rows ||
          column + 2 >= sharp.image.columns)
        continue;
      bool amid = true;
      for (int r = row - 2; r <= row + 2; ++r) {
        for (int c = column - 2; c <= column + 2; ++c) {
          const auto& other = sharp.labels[static_cast<std::size_t>(sharp.image.cell(r, c))];
          amid = amid && other.object == sharp.labels[at_cell].object && other.face == sharp.labels[at_cell].face;
        }
      }
      const double off = std::abs(static_cast<double>(sharp.image[cell].z() - smooth.image[cell].z()));
      if (amid) {
        EXPECT_LT(off, 0.01) << row << " " << column;
      } else {
        unlike += off > 1.0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(unlike, 50);
}

TEST(SensorSimulator, noise_of_a_cell_does_not_depend_on_other_cells) {
  SensorModel sensor = exact_sensor();
  sensor.depth_noise = 0.7;
  const CadModel model = box(60, 60, 10);
  const PlacedObject object{&model, at({-30, -30, 900})};
  const BackgroundPlane wall{Vector3d(0, 0, -1), -1000};
  const SimulatedScan lone = SimulatedScene({&object, 1}).scan(sensor, Random(3));
  const SimulatedScan walled = SimulatedScene({&object, 1}, {&wall, 1}).scan(sensor, Random(3));
  for (int cell = 0; cell < lone.image.size(); ++cell) {
    if (!lone.image.valid(cell)) continue;
    EXPECT_EQ(lone.image[cell], walled.image[cell]);
  }
}

TEST(SensorSimulator, shadow_falls_away_from_the_projector) {
  SensorModel sensor = exact_sensor();
  const CadModel model = box(40, 40, 40);
  const PlacedObject object{&model, at({-20, -20, 880})};
  const BackgroundPlane wall{Vector3d(0, 0, -1), -960};
  const SimulatedScene scene({&object, 1}, {&wall, 1});
  EXPECT_EQ(count_valid(scene.scan(sensor, Random(1)).image), sensor.camera.rows * sensor.camera.columns);
  for (const double side : {-1.0, 1.0}) {
    sensor.projector = Vector3d(side * 400, 0, 0);
    const SimulatedScan scan = scene.scan(sensor, Random(1));
    // The block's near face is 4.2 cells to each side of column 31; its shadow on the wall starts at its outline.
    const auto valid = [&](double column) { return scan.image.valid(scan.image.cell(30, static_cast<int>(column))); };
    EXPECT_TRUE(valid(31));
    EXPECT_TRUE(valid(31 + side * 6));
    EXPECT_FALSE(valid(31 - side * 6));
    EXPECT_TRUE(valid(31 - side * 20));
  }
}

TEST(SensorSimulator, shadow_edge_is_where_the_light_grazes_the_block) {
  SensorModel sensor = exact_sensor();
  sensor.projector = Vector3d(300, 0, 0);
  const CadModel model = box(40, 400, 40);  // a long bar: the shadow has straight edges
  const PlacedObject object{&model, at({-20, -200, 880})};
  const BackgroundPlane wall{Vector3d(0, 0, -1), -960};
  const SimulatedScan scan = SimulatedScene({&object, 1}, {&wall, 1}).scan(sensor, Random(1));
  for (int column = 0; column < sensor.camera.columns; ++column) {
    const double x = 960.0 * sensor.camera.ray(30, column).x();
    if (x > 20.0 * 960 / 880 || x < -200.0) continue;
    const bool behind_the_bar = x > -20.0 * 960 / 880;
    // From the projector past the corner at (-20, 880), on to depth 960.
    const double edge = 300.0 + (-20.0 - 300.0) * 960.0 / 880.0;
    const bool expected = behind_the_bar || x < edge;
    EXPECT_EQ(scan.image.valid(scan.image.cell(30, column)), expected) << column;
  }
}

TEST(SensorSimulator, light_never_adds_cells_and_a_light_at_the_camera_casts_no_shadow) {
  SensorModel sensor = exact_sensor();
  const CadModel model = angle_block();
  int shadowed = 0;
  for (std::uint64_t view = 0; view < 10; ++view) {
    const PlacedObject object{&model, some_view(view)};
    const SimulatedScene scene({&object, 1});
    sensor.projector.reset();
    const SimulatedScan all = scene.scan(sensor, Random(1));
    sensor.projector = Vector3d(300, 50, 20);
    const SimulatedScan lit = scene.scan(sensor, Random(1));
    sensor.projector = Vector3d::Zero();
    const SimulatedScan from_camera = scene.scan(sensor, Random(1));
    for (int cell = 0; cell < all.image.size(); ++cell) EXPECT_TRUE(!lit.image.valid(cell) || all.image.valid(cell));
    shadowed += labelled(all) - labelled(lit);
    // One cell may lie on an outline, where the start moved off the surface decides.
    EXPECT_GE(labelled(from_camera), labelled(all) - 1) << view;
  }
  EXPECT_GT(shadowed, 50);
}

TEST(SensorSimulator, grazing_surfaces_drop_out_monotonically) {
  SensorModel sensor = exact_sensor();
  const CadModel model = box(100, 100, 100);
  const double tilt = 1.2;
  Pose pose{Eigen::AngleAxisd(tilt, Vector3d::UnitX()).toRotationMatrix(), Vector3d::Zero()};
  pose.translation = Vector3d(0, 0, 900) - pose.rotation * Vector3d(50, 50, 50);
  const PlacedObject object{&model, pose};
  const SimulatedScene scene({&object, 1});
  int before = 0;
  for (const double limit : {0.1, 0.3, 0.5, 1.1, 1.3, std::numbers::pi / 2}) {
    sensor.largest_incidence = limit;
    const SimulatedScan scan = scene.scan(sensor, Random(1));
    for (int cell = 0; cell < scan.image.size(); ++cell) {
      if (!scan.image.valid(cell)) continue;
      const auto face = static_cast<std::size_t>(scan.labels[static_cast<std::size_t>(cell)].face);
      const Vector3d towards = -scan.image[cell].cast<double>().normalized();
      EXPECT_GE(towards.dot(pose.rotation * model.faces[face].normal), std::cos(limit) - 1e-6);
    }
    EXPECT_GE(labelled(scan), before);
    before = labelled(scan);
  }
  EXPECT_GT(before, 100);
}

TEST(SensorSimulator, nothing_is_measured_far_outside_the_working_range) {
  SensorModel sensor = exact_sensor();
  sensor.nearest_distance = 800;
  sensor.farthest_distance = 1000;
  const auto cells_at = [&](double depth) {
    const BackgroundPlane wall{Vector3d(0, 0, -1), -depth};
    return count_valid(SimulatedScene({}, {&wall, 1}).scan(sensor, Random(1)).image);
  };
  EXPECT_EQ(cells_at(399), 0);
  EXPECT_EQ(cells_at(401), 60 * 64);
  EXPECT_EQ(cells_at(1499), 60 * 64);
  EXPECT_EQ(cells_at(1501), 0);
}

TEST(SensorSimulator, empty_scene_gives_no_data) {
  const SimulatedScene scene({});
  EXPECT_EQ(count_valid(scene.scan(exact_sensor(), Random(1)).image), 0);
  EXPECT_LT(scene.cast(Vector3d::Zero(), Vector3d::UnitZ()).distance, 0.0);
  EXPECT_TRUE(scene.sees(Vector3d::Zero(), Vector3d(0, 0, 100)));
}

TEST(SensorSimulator, background_does_not_matter_which_way_its_normal_points) {
  const CadModel model = wedge();
  const PlacedObject object{&model, some_view(2)};
  SensorModel sensor = exact_sensor();
  sensor.projector = Vector3d(250, 0, 0);
  const BackgroundPlane towards{Vector3d(0, -0.6, -0.8), -800};
  const BackgroundPlane away{Vector3d(0, 0.6, 0.8), 800};
  const SimulatedScan a = SimulatedScene({&object, 1}, {&towards, 1}).scan(sensor, Random(1));
  const SimulatedScan b = SimulatedScene({&object, 1}, {&away, 1}).scan(sensor, Random(1));
  EXPECT_GT(count_valid(a.image), labelled(a));
  EXPECT_TRUE(same_bits(a, b));
}

TEST(SensorSimulator, camera_is_recovered_from_a_simulated_image) {
  SensorModel sensor = exact_sensor();
  sensor.depth_quantization = 0.1;
  const CadModel model = angle_block();
  const PlacedObject object{&model, some_view(4)};
  const auto camera = fit_camera(SimulatedScene({&object, 1}).scan(sensor, Random(1)).image);
  ASSERT_TRUE(camera);
  EXPECT_NEAR(camera->fx, sensor.camera.fx, 1e-2);
  EXPECT_NEAR(camera->fy, sensor.camera.fy, 1e-2);
  EXPECT_NEAR(camera->cx, sensor.camera.cx, 1e-2);
  EXPECT_NEAR(camera->cy, sensor.camera.cy, 1e-2);
}

TEST(SensorSimulator, no_ray_slips_between_triangles) {
  // A fan of slivers about a point inside the view: every ray inside the outline must hit.
  std::vector<Eigen::Vector2d> outline;
  std::vector<std::array<int, 3>> cap;
  for (int i = 0; i < 90; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 90;
    outline.emplace_back(60 * std::cos(angle), 60 * std::sin(angle));
  }
  for (int i = 1; i + 1 < 90; ++i) cap.push_back({0, i, i + 1});
  const CadModel disc = test::prism("disc", outline, cap, 10);
  const PlacedObject object{&disc,
                            {Eigen::AngleAxisd(0.3, Vector3d(1, 2, 3).normalized()).toRotationMatrix(), {1, 2, 900}}};
  const SimulatedScene scene({&object, 1});
  Random random(11);
  for (int i = 0; i < 20000; ++i) {
    const double radius = 59.0 * std::sqrt(random.uniform());
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    const Vector3d target = object.T_sensor_model * Vector3d(radius * std::cos(angle), radius * std::sin(angle), 5);
    ASSERT_GE(scene.cast(Vector3d::Zero(), target).distance, 0.0);
  }
}

TEST(SensorSimulator, scans_show_what_each_ray_meets_wherever_the_object_is) {
  const SensorModel sensor = exact_sensor();
  const CadModel model = angle_block();
  int shown = 0;
  for (std::uint64_t index = 0; index < 24; ++index) {
    Pose pose = some_view(index, 500.0);
    // In the middle, over a border or a corner of the image, around the camera.
    pose.translation +=
        Vector3d(index % 2 == 0 ? 0.0 : 85.0, index % 3 == 0 ? 0.0 : -75.0, index % 4 == 3 ? -490.0 : 0.0);
    const PlacedObject object{&model, pose};
    const SimulatedScene scene({&object, 1});
    SensorModel wide = sensor;  // takes whatever is hit from outside
    wide.nearest_distance = 1e-3;
    wide.farthest_distance = 1e6;
    const SimulatedScan scan = scene.scan(wide, Random(1));
    for (int row = 0; row < sensor.camera.rows; ++row) {
      for (int column = 0; column < sensor.camera.columns; ++column) {
        const Vector3d ray = sensor.camera.ray(row, column);
        const SimulatedScene::Hit hit = scene.cast(Vector3d::Zero(), ray);
        const CellLabel& label = scan.labels[static_cast<std::size_t>(scan.image.cell(row, column))];
        const bool facing =
            hit.face >= 0 && (pose.rotation * model.faces[static_cast<std::size_t>(hit.face)].normal).dot(ray) < 0.0;
        ASSERT_EQ(label.face, facing ? hit.face : -1) << index << ": " << row << ", " << column;
        shown += facing ? 1 : 0;
      }
    }
  }
  EXPECT_GT(shown, 1000);
}

TEST(SensorSimulator, cast_measures_distance_in_mm_whatever_the_length_of_the_direction) {
  const CadModel model = box(10, 20, 30);
  const PlacedObject object{&model, Pose{}};
  const SimulatedScene scene({&object, 1});
  for (const double length : {0.01, 1.0, 50.0}) {
    const auto hit = scene.cast({-40, 10, 10}, length * Vector3d::UnitX());
    EXPECT_NEAR(hit.distance, 40.0, 1e-9);
    EXPECT_EQ(hit.object, 0);
    EXPECT_NEAR((model.faces[static_cast<std::size_t>(hit.face)].normal + Vector3d::UnitX()).norm(), 0.0, 1e-12);
  }
  EXPECT_LT(scene.cast({-40, 10, 10}, -Vector3d::UnitX()).distance, 0.0);
}

TEST(SensorSimulator, sees_a_face_from_its_outside_only) {
  for (const CadModel& model : {box(90, 60, 40), wedge()}) {
    const PlacedObject object{&model, Pose{}};
    const SimulatedScene scene({&object, 1});
    Random random(2);
    for (int i = 0; i < 500; ++i) {
      const Vector3d eye = 900.0 * random.direction();
      for (const CadFace& face : model.faces) {
        const double height = face.normal.dot(eye) - face.offset;
        if (std::abs(height) < 20.0) continue;
        EXPECT_EQ(scene.sees(eye, face.centroid), height > 0.0);  // convex: nothing else is in the way
      }
    }
  }
}

TEST(SensorSimulator, sees_is_blocked_by_another_object_and_by_a_plane) {
  const CadModel model = box(20, 20, 20);
  const PlacedObject object{&model, at({-10, -10, 400})};
  const SimulatedScene open({&object, 1});
  EXPECT_FALSE(open.sees(Vector3d::Zero(), {0, 0, 900}));
  EXPECT_TRUE(open.sees(Vector3d::Zero(), {0, 0, 300}));
  EXPECT_TRUE(open.sees({500, 0, 0}, {0, 0, 900}));
  const BackgroundPlane wall{Vector3d(0, 0, -1), -600};
  const SimulatedScene walled({&object, 1}, {&wall, 1});
  EXPECT_FALSE(walled.sees({500, 0, 0}, {0, 0, 900}));
  EXPECT_TRUE(walled.sees({500, 0, 0}, {0, 0, 590}));
}

// Two ways to the same surface: Embree's rays, and triangles filled cell by cell.
TEST(SensorSimulator, sees_what_the_runtime_draws) {
  SensorModel sensor;
  sensor.depth_quantization = 0.0;
  for (const char* name : {"castle", "stick"}) {
    const CadModel cad = read_cad_model(test::project_file(std::string("models/") + name + ".off"));
    CompiledModel compiled;
    for (const Vector3d& vertex : cad.vertices) compiled.vertices.push_back(vertex.cast<float>());
    compiled.triangles = cad.triangles;
    for (std::uint64_t view = 0; view < 8; ++view) {
      const PlacedObject object{&cad, some_view(view)};
      const RangeImage image = SimulatedScene({&object, 1}).scan(sensor, Random(1)).image;
      const Rendering drawn = render(compiled, object.T_sensor_model, sensor.camera);
      int same = 0;
      int differ = 0;
      for (int cell = 0; cell < image.size(); ++cell) {
        const int row = cell / image.columns - drawn.first_row;
        const int column = cell % image.columns - drawn.first_column;
        const bool inside = row >= 0 && row < drawn.rows && column >= 0 && column < drawn.columns;
        const float depth = inside ? drawn.depth[static_cast<std::size_t>(drawn.cell(row, column))] : 0.0F;
        if (!image.valid(cell) && depth == 0.0F) continue;
        const bool equal = image.valid(cell) && std::abs(image[cell].z() - depth) < 0.01F;
        (equal ? same : differ) += 1;
      }
      EXPECT_GT(same, 500) << name << ", view " << view;
      EXPECT_LE(differ, 3) << name << ", view " << view;  // on outlines, where rounding decides
    }
  }
}

TEST(ViewPose, puts_the_centre_on_the_axis_and_looks_along_the_direction) {
  std::vector<Vector3d> directions = {Vector3d::UnitX(),
                                      Vector3d::UnitY(),
                                      Vector3d::UnitZ(),
                                      -Vector3d::UnitX(),
                                      -Vector3d::UnitY(),
                                      -Vector3d::UnitZ(),
                                      Vector3d(1e-12, 0, 1).normalized(),
                                      Vector3d(0, 1e-9, -1).normalized()};
  Random random(1);
  for (int i = 0; i < 200; ++i) directions.push_back(random.direction());
  const Vector3d centre(12, -7, 30);
  for (const Vector3d& direction : directions) {
    for (const double roll : {0.0, 1.0, -2.5}) {
      const Pose pose = view_pose(direction, centre, 800, roll);
      EXPECT_TRUE(is_rotation(pose.rotation, 1e-12));
      EXPECT_NEAR((pose * centre - Vector3d(0, 0, 800)).norm(), 0.0, 1e-9);
      EXPECT_NEAR((pose.rotation * direction + Vector3d::UnitZ()).norm(), 0.0, 1e-12);
      const Eigen::Matrix3d turn = pose.rotation * view_pose(direction, centre, 800, 0.0).rotation.transpose();
      EXPECT_NEAR((turn - rotation_from_vector({0, 0, roll})).norm(), 0.0, 1e-12);
    }
  }
}

TEST(ViewPose, shows_the_models_z_axis_upright) {
  const Pose pose = view_pose(Vector3d(1, 2, 0.5).normalized(), Vector3d::Zero(), 900, 0.0);
  const Vector3d up = pose.rotation * Vector3d::UnitZ();
  EXPECT_NEAR(up.x(), 0.0, 1e-12);
  EXPECT_LT(up.y(), 0.0);
}

}  // namespace
}  // namespace foresight
