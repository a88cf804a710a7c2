// What the tests of the programs share: databases and scans made once a process, by the programs themselves.
#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/programs/run_program.h"
#include "tests/support.h"

namespace foresight::test {

using Json = nlohmann::json;

inline std::string castle() { return project_file("models/castle.off"); }
inline std::string stick() { return project_file("models/stick.off"); }

// Where everything below lies.
inline const TemporaryFolder& workshop() {
  static const TemporaryFolder folder;
  return folder;
}

// For what the tests stand on, rather than test.
inline void must_succeed(const Outcome& outcome) {
  if (outcome.code != 0 || !outcome.err.empty())
    throw std::runtime_error("cannot prepare the test: " + outcome.err + outcome.out);
}

// Castle and stick, from few views; so few that only smoothed densities hold what other views show.
inline const std::string& two_objects() {
  static const std::string file = [] {
    const std::string made = workshop().file("two objects.db");  // with a blank, as users have them
    must_succeed(foresightc({"compile", castle(), stick(), "-o", made, "--views", "80", "--kernel", "0.5"}));
    return made;
  }();
  return file;
}

// The least database there is: one object, fewest views.
inline const std::string& one_object() {
  static const std::string file = [] {
    const std::string made = workshop().file("one_object.db");
    must_succeed(foresightc({"compile", stick(), "-o", made, "--views", "20"}));
    return made;
  }();
  return file;
}

struct TrueObject {
  std::string name;
  Json T_sensor_model;  // four rows
};

struct SimulatedScene {
  std::string scan;  // path
  std::vector<TrueObject> objects;
};

inline std::vector<SimulatedScene> read_scenes(const std::string& folder) {
  std::vector<SimulatedScene> scenes;
  const Json truth = Json::parse(file_content(folder + "/truth.json"));
  for (const Json& scan : truth["scans"]) {
    SimulatedScene& scene = scenes.emplace_back();
    scene.scan = folder + "/" + scan["scan"].get<std::string>();
    for (const Json& object : scan["objects"]) scene.objects.push_back({object["object"], object["T_sensor_model"]});
  }
  return scenes;
}

inline std::vector<SimulatedScene> simulate(const std::string& name, const std::vector<std::string>& options) {
  const std::string folder = workshop().file(name);
  std::vector<std::string> arguments = {"simulate", castle(), stick(), "-o", folder, "--seed", "7"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  must_succeed(foresightc(arguments));
  return read_scenes(folder);
}

// Scenes of one object each, seen by the paper's sensor.
inline const std::vector<SimulatedScene>& single_scenes() {
  static const std::vector<SimulatedScene> scenes = simulate("single", {"--scenes", "10"});
  return scenes;
}

// Scenes of both objects.
inline const std::vector<SimulatedScene>& pair_scenes() {
  static const std::vector<SimulatedScene> scenes = simulate("pair", {"--scenes", "6", "--objects", "2"});
  return scenes;
}

// A scene of the stick, the object without symmetry: its pose has one answer.
inline const SimulatedScene& stick_scene() {
  for (const SimulatedScene& scene : single_scenes()) {
    if (scene.objects[0].name == "stick") return scene;
  }
  throw std::runtime_error("no scene shows the stick");
}

}  // namespace foresight::test
