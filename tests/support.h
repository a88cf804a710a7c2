// Shared by the tests: where things are, and small inputs built in code.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace foresight::test {

// A file of the project, from its root.
inline std::string project_file(const std::string& path) { return std::string(FORESIGHT_SOURCE_DIR) + "/" + path; }

// The folder of real scans that may stand beside the checkout (or where FORESIGHT_DATA says), or empty.
inline std::string real_data_folder() {
  const char* set = std::getenv("FORESIGHT_DATA");
  const std::string folder = set != nullptr ? set : project_file("../shared/data");
  return std::filesystem::exists(folder) ? folder : std::string();
}

// A fresh folder for one test's files, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "foresight-test-XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::string file(const std::string& name) const { return path_ + "/" + name; }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace foresight::test
