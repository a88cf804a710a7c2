#include "compiler/scene_generator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <set>

#include "common/errors.h"
#include "tests/compiler/solids.h"

namespace foresight {
namespace {

using Eigen::Vector3d;

SensorModel small_sensor() {
  SensorModel sensor;
  sensor.camera = {120, 128, 385.0, 385.0, 63.5, 59.5};
  return sensor;
}

// Six solids, two of them not convex, 80 to 130 mm.
std::vector<CadModel> six_models() {
  std::vector<CadModel> models = {test::box(90, 60, 40), test::angle_block(), test::wedge(),
                                  test::box(50, 50, 50), test::angle_block(), test::box(100, 30, 20)};
  for (std::size_t i = 0; i < models.size(); ++i) models[i].name = "model_" + std::to_string(i);
  return models;
}

const CadModel& model_of(const SceneObject& object, const std::vector<CadModel>& models) {
  return models[static_cast<std::size_t>(object.model)];
}

std::vector<Vector3d> vertices_of(const SceneObject& object, const std::vector<CadModel>& models) {
  std::vector<Vector3d> vertices;
  for (const Vector3d& vertex : model_of(object, models).vertices) vertices.push_back(object.T_sensor_model * vertex);
  return vertices;
}

// Winding number by solid angles (Van Oosterom and Strackee, 1983): 1 inside, 0 outside, whatever the shape.
bool contains(const CadModel& model, const Vector3d& point) {
  double angle = 0.0;
  for (const auto& triangle : model.triangles) {
    const Vector3d a = model.vertices[static_cast<std::size_t>(triangle[0])] - point;
    const Vector3d b = model.vertices[static_cast<std::size_t>(triangle[1])] - point;
    const Vector3d c = model.vertices[static_cast<std::size_t>(triangle[2])] - point;
    angle += 2.0 * std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                     b.dot(c) * a.norm() + c.dot(a) * b.norm());
  }
  return angle > 2.0 * std::numbers::pi;
}

// Two closed surfaces cross exactly when an edge of one meets the other; else one may still hold the other.
bool interpenetrate(const SceneObject& a, const SceneObject& b, const std::vector<CadModel>& models) {
  std::vector<Vector3d> vertices = vertices_of(a, models);
  // Shrunk by a thousandth, far less than the gap asked for: two bodies on one table have coplanar undersides, and
  // where a ray within a plane meets a triangle of that plane is not defined.
  const Vector3d middle =
      std::accumulate(vertices.begin(), vertices.end(), Vector3d(0, 0, 0)) / static_cast<double>(vertices.size());
  for (Vector3d& vertex : vertices) vertex += 1e-3 * (middle - vertex);
  const PlacedObject other{&model_of(b, models), b.T_sensor_model};
  const SimulatedScene scene({&other, 1});
  if (contains(*other.model, b.T_sensor_model.inverse() * vertices.front())) return true;
  for (const auto& triangle : model_of(a, models).triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d& from = vertices[static_cast<std::size_t>(triangle[k])];
      const Vector3d edge = vertices[static_cast<std::size_t>(triangle[(k + 1) % 3])] - from;
      const double distance = scene.cast(from, edge).distance;
      if (distance >= 0.0 && distance <= edge.norm()) return true;
    }
  }
  return false;
}

bool any_interpenetrate(const Scene& scene, const std::vector<CadModel>& models) {
  for (const SceneObject& a : scene.objects) {
    for (const SceneObject& b : scene.objects) {
      if (&a != &b && interpenetrate(a, b, models)) return true;
    }
  }
  return false;
}

bool inside_image(const SceneObject& object, const std::vector<CadModel>& models, const SensorModel& sensor) {
  const std::vector<Vector3d> vertices = vertices_of(object, models);
  return std::all_of(vertices.begin(), vertices.end(),
                     [&](const Vector3d& vertex) { return sensor.camera.cell_of(vertex) >= 0; });
}

TEST(SceneGenerator, test_of_this_test_finds_interpenetration) {
  const std::vector<CadModel> models = six_models();
  SceneObject a{0, {Eigen::Matrix3d::Identity(), {0, 0, 900}}, 0, 0};
  SceneObject b = a;
  b.T_sensor_model.translation.x() += 89;
  EXPECT_TRUE(interpenetrate(a, b, models) || interpenetrate(b, a, models));
  b.T_sensor_model.translation.x() += 2;
  EXPECT_FALSE(interpenetrate(a, b, models) || interpenetrate(b, a, models));
  const std::vector<CadModel> nested = {test::box(90, 60, 40), test::box(10, 10, 10)};
  const SceneObject inner{1, {Eigen::Matrix3d::Identity(), {5, 5, 905}}, 0, 0};
  EXPECT_TRUE(interpenetrate(a, inner, nested) || interpenetrate(inner, a, nested));
}

TEST(SceneGenerator, same_seed_and_index_give_the_same_scene) {
  const std::vector<CadModel> models = six_models();
  SensorModel sensor = small_sensor();
  sensor.depth_noise = 0.5;
  const SceneOptions options{2, 4, true};
  const Scene a = generate_scene(models, sensor, options, 9, 3);
  const Scene b = generate_scene(models, sensor, options, 9, 3);
  EXPECT_EQ(truth_json({a}, models, {"s"}, sensor, 9), truth_json({b}, models, {"s"}, sensor, 9));
  const std::size_t bytes = a.scan.image.points.size() * sizeof(Eigen::Vector3f);
  EXPECT_EQ(std::memcmp(a.scan.image.points.data(), b.scan.image.points.data(), bytes), 0);
  const Scene next = generate_scene(models, sensor, options, 9, 4);
  const Scene reseeded = generate_scene(models, sensor, options, 10, 3);
  EXPECT_NE(std::memcmp(a.scan.image.points.data(), next.scan.image.points.data(), bytes), 0);
  EXPECT_NE(std::memcmp(a.scan.image.points.data(), reseeded.scan.image.points.data(), bytes), 0);
}

TEST(SceneGenerator, measures_the_visibility_of_one_model_where_no_more_is_asked) {
  const std::vector<CadModel> models = six_models();
  const SensorModel sensor = small_sensor();
  const Scene all = generate_scene(models, sensor, {3, 3, true}, 9, 3);
  const int one = all.objects[1].model;
  const Scene single = generate_scene(models, sensor, {3, 3, true, one}, 9, 3);
  ASSERT_EQ(single.objects.size(), all.objects.size());
  for (std::size_t i = 0; i < all.objects.size(); ++i) {
    EXPECT_EQ(single.objects[i].T_sensor_model.translation, all.objects[i].T_sensor_model.translation);
    EXPECT_EQ(single.objects[i].visible_fraction, all.objects[i].model == one ? all.objects[i].visible_fraction : 0.0);
  }
  EXPECT_GT(all.objects[1].visible_fraction, 0.0);
}

TEST(SceneGenerator, single_object_is_inside_the_image_in_the_working_range_and_wholly_visible) {
  const std::vector<CadModel> models = six_models();
  SensorModel sensor = small_sensor();
  sensor.nearest_distance = 800;
  sensor.farthest_distance = 1000;
  sensor.projector = Vector3d(200, 0, 0);
  sensor.depth_noise = 0.4;
  std::set<int> drawn;
  for (std::uint64_t index = 0; index < 60; ++index) {
    const Scene scene = generate_scene(models, sensor, {1, 1, false}, 1, index);
    ASSERT_EQ(scene.objects.size(), 1U);
    const SceneObject& object = scene.objects[0];
    drawn.insert(object.model);
    EXPECT_TRUE(scene.background.empty());
    EXPECT_TRUE(is_rotation(object.T_sensor_model.rotation, 1e-12));
    EXPECT_TRUE(inside_image(object, models, sensor));
    EXPECT_EQ(object.visible_fraction, 1.0);
    EXPECT_GE(object.visible_faces, 1);
    for (const Vector3d& vertex : vertices_of(object, models)) {
      EXPECT_GT(vertex.z(), 800.0 - 70.0);
      EXPECT_LT(vertex.z(), 1000.0 + 70.0);
    }
  }
  EXPECT_EQ(drawn.size(), models.size());
}

TEST(SceneGenerator, rotations_of_single_objects_are_uniform) {
  const std::vector<CadModel> models = {test::box(40, 40, 40)};
  SensorModel sensor = small_sensor();
  sensor.camera = {32, 32, 90.0, 90.0, 15.5, 15.5};
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  const int count = 600;
  for (int i = 0; i < count; ++i) {
    sum += generate_scene(models, sensor, {}, 4, static_cast<std::uint64_t>(i)).objects[0].T_sensor_model.rotation;
  }
  // Each entry of a uniform rotation has variance 1/3.
  EXPECT_LT((sum / count).cwiseAbs().maxCoeff(), 4.5 / std::sqrt(3.0 * count));
}

TEST(SceneGenerator, object_that_barely_fits_is_still_placed) {
  const std::vector<CadModel> models = {test::box(260, 260, 5)};
  const Scene scene = generate_scene(models, small_sensor(), {}, 1, 1);
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_GT(count_valid(scene.scan.image), 0);
}

TEST(SceneGenerator, floating_objects_never_interpenetrate_and_do_hide_one_another) {
  const std::vector<CadModel> models = six_models();
  const SensorModel sensor = small_sensor();
  int partly_hidden = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Scene scene = generate_scene(models, sensor, {3, 6, false}, seed, 0);
    ASSERT_GE(scene.objects.size(), 3U);
    ASSERT_LE(scene.objects.size(), 6U);
    std::set<int> used;
    for (const SceneObject& object : scene.objects) {
      used.insert(object.model);
      EXPECT_TRUE(inside_image(object, models, sensor)) << seed;
      EXPECT_GE(object.visible_fraction, 0.0);
      EXPECT_LE(object.visible_fraction, 1.0);
      if (object.visible_fraction < 0.95) ++partly_hidden;
    }
    EXPECT_EQ(used.size(), scene.objects.size());
    EXPECT_FALSE(any_interpenetrate(scene, models)) << seed;
  }
  EXPECT_GT(partly_hidden, 20);
}

TEST(SceneGenerator, objects_on_a_table_rest_on_it_apart_and_stable) {
  const std::vector<CadModel> models = six_models();
  SensorModel sensor = small_sensor();
  sensor.projector = Vector3d(250, 0, 0);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Scene scene = generate_scene(models, sensor, {2, 5, true}, seed, 7);
    ASSERT_EQ(scene.background.size(), 1U);
    const BackgroundPlane& table = scene.background[0];
    EXPECT_NEAR(table.normal.norm(), 1.0, 1e-12);
    const double elevation = std::asin(-table.normal.z()) * 180.0 / std::numbers::pi;
    EXPECT_GE(elevation, 30.0);
    EXPECT_LE(elevation, 60.0);
    EXPECT_LT(table.normal.y(), 0.0);  // up in the image
    EXPECT_LT(table.offset, 0.0);      // the sensor is above it
    for (const SceneObject& object : scene.objects) {
      EXPECT_TRUE(inside_image(object, models, sensor)) << seed;
      int contacts = 0;
      for (const Vector3d& vertex : vertices_of(object, models)) {
        const double height = table.normal.dot(vertex) - table.offset;
        EXPECT_GE(height, -1e-6);
        if (height < 1e-3) ++contacts;
      }
      EXPECT_GE(contacts, 3);
    }
    EXPECT_FALSE(any_interpenetrate(scene, models)) << seed;
  }
}

// A slender prism cut so obliquely that it cannot stand on its ends: it must always lie down.
TEST(SceneGenerator, objects_never_stand_where_they_would_fall_over) {
  CadModel leaning = test::box(20, 20, 100);
  for (std::size_t i = 4; i < 8; ++i) leaning.vertices[i].x() += 60.0;
  const std::vector<CadModel> models = {leaning};
  bool on_side[3] = {false, false, false};
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Scene scene = generate_scene(models, small_sensor(), {1, 1, true}, seed, 0);
    const Vector3d down = scene.objects[0].T_sensor_model.rotation.transpose() * -scene.background[0].normal;
    EXPECT_LT(std::abs(down.z()), 0.999) << "stands on an end";
    on_side[std::abs(down.y()) > 0.999 ? 0 : 1] = true;
  }
  EXPECT_TRUE(on_side[0]);
  EXPECT_TRUE(on_side[1]);
}

TEST(SceneGenerator, a_crowd_gets_more_room_or_fewer_objects_but_never_interpenetrates) {
  std::vector<CadModel> models;
  for (int i = 0; i < 6; ++i) models.push_back(test::box(150, 150, 100));
  for (const bool background : {false, true}) {
    const Scene all = generate_scene(models, small_sensor(), {6, 6, background}, 1, 0);
    EXPECT_EQ(all.objects.size(), 6U);
    EXPECT_FALSE(any_interpenetrate(all, models));
    const Scene some = generate_scene(models, small_sensor(), {1, 6, background}, 1, 1);
    EXPECT_GE(some.objects.size(), 1U);
    EXPECT_FALSE(any_interpenetrate(some, models));
  }
}

TEST(SceneGenerator, visibility_counts_the_cells_of_the_scan) {
  const std::vector<CadModel> models = six_models();
  const Scene scene = generate_scene(models, small_sensor(), {5, 6, false}, 3, 0);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    std::vector<int> cells(model_of(scene.objects[i], models).faces.size(), 0);
    for (const CellLabel& label : scene.scan.labels) {
      if (label.object == static_cast<int>(i)) ++cells[static_cast<std::size_t>(label.face)];
    }
    const auto faces = std::count_if(cells.begin(), cells.end(), [](int n) { return n >= 12; });
    EXPECT_EQ(scene.objects[i].visible_faces, faces);
    if (scene.objects[i].visible_fraction == 0.0) {
      EXPECT_EQ(faces, 0);
    }
  }
}

// Cells on an object alone.
int cells_alone(const SceneObject& object, const std::vector<CadModel>& models, const SensorModel& sensor) {
  const PlacedObject lone{&model_of(object, models), object.T_sensor_model};
  const SimulatedScan scan = SimulatedScene({&lone, 1}).scan(sensor, Random(0));
  return static_cast<int>(
      std::count_if(scan.labels.begin(), scan.labels.end(), [](const CellLabel& label) { return label.object == 0; }));
}

// Objects too many to fit, so that some reach over the border of the image.
TEST(SceneGenerator, what_lies_beyond_the_image_is_not_visible) {
  std::vector<CadModel> models;
  for (int i = 0; i < 6; ++i) models.push_back(test::box(150, 150, 100));
  SensorModel wide = small_sensor();
  constexpr int kMargin = 150;
  wide.camera.columns += 2 * kMargin;
  wide.camera.rows += 2 * kMargin;
  wide.camera.cx += kMargin;
  wide.camera.cy += kMargin;
  int reaching_over = 0;
  int about_half = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Scene scene = generate_scene(models, small_sensor(), {6, 6, false}, seed, 0);
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
      const SceneObject& object = scene.objects[i];
      const auto seen = std::count_if(scene.scan.labels.begin(), scene.scan.labels.end(),
                                      [&](const CellLabel& label) { return label.object == static_cast<int>(i); });
      const int whole = cells_alone(object, models, wide);
      ASSERT_GT(whole, 100);
      EXPECT_NEAR(object.visible_fraction, static_cast<double>(seen) / whole, 0.02) << seed << " " << i;
      const double inside = static_cast<double>(cells_alone(object, models, small_sensor())) / whole;
      EXPECT_LE(object.visible_fraction, inside + 0.02);
      reaching_over += inside < 0.95 ? 1 : 0;
      about_half += inside > 0.35 && inside < 0.65 ? 1 : 0;
    }
  }
  EXPECT_GT(reaching_over, 5);
  EXPECT_GT(about_half, 0);
}

TEST(SceneGenerator, truth_file_says_what_the_scenes_hold) {
  const std::vector<CadModel> models = six_models();
  const SensorModel sensor = small_sensor();
  const std::vector<Scene> scenes = {generate_scene(models, sensor, {2, 3, true}, 8, 0),
                                     generate_scene(models, sensor, {1, 1, false}, 8, 1)};
  const std::string text = truth_json(scenes, models, {"scene_000", "scene_001"}, sensor, 8);
  const auto truth = nlohmann::ordered_json::parse(text);
  EXPECT_EQ(truth.at("unit"), "mm");
  EXPECT_EQ(truth.at("sensor"), sensor.name);
  EXPECT_EQ(truth.at("seed"), 8);
  ASSERT_EQ(truth.at("scans").size(), 2U);
  EXPECT_EQ(truth["scans"][1]["scan"], "scene_001");
  EXPECT_EQ(truth["scans"][0]["background"].size(), 1U);
  EXPECT_EQ(truth["scans"][1]["background"].size(), 0U);
  for (std::size_t s = 0; s < 2; ++s) {
    const auto& objects = truth["scans"][s]["objects"];
    ASSERT_EQ(objects.size(), scenes[s].objects.size());
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const SceneObject& object = scenes[s].objects[i];
      EXPECT_EQ(objects[i]["object"], model_of(object, models).name);
      EXPECT_EQ(objects[i]["visible_fraction"].get<double>(), object.visible_fraction);
      EXPECT_EQ(objects[i]["visible_faces"].get<int>(), object.visible_faces);
      const auto& matrix = objects[i]["T_sensor_model"];
      ASSERT_EQ(matrix.size(), 4U);
      for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
          const double expected = row == 3      ? (column == 3 ? 1.0 : 0.0)
                                  : column == 3 ? object.T_sensor_model.translation(row)
                                                : object.T_sensor_model.rotation(row, column);
          EXPECT_EQ(matrix[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)].get<double>(), expected);
        }
      }
    }
  }
}

TEST(SceneGenerator, options_that_cannot_be_met_are_refused) {
  EXPECT_NO_THROW(check(SceneOptions{1, 3, false}, 3));
  EXPECT_THROW(check(SceneOptions{0, 1, false}, 3), UsageError);
  EXPECT_THROW(check(SceneOptions{3, 2, false}, 3), UsageError);
  EXPECT_THROW(check(SceneOptions{1, 4, false}, 3), UsageError);
  EXPECT_THROW(check(SceneOptions{1, 1, false}, 0), UsageError);
}

}  // namespace
}  // namespace foresight
