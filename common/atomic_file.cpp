#include "common/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "common/errors.h"

namespace foresight {
namespace {

// Endless devices and accidents stop here instead of filling the memory; no scan, CAD file or database comes near.
constexpr std::size_t kLargestFile = std::size_t{4} << 30;

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] bool open() const { return number_ >= 0; }
  // False when the last bytes did not reach the file.
  [[nodiscard]] bool close() {
    const int number = number_;
    number_ = -1;
    return ::close(number) == 0;
  }

 private:
  int number_;
};

// Removes the temporary unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::string file) : file_(std::move(file)) {}
  ~TemporaryFile() {
    if (!file_.empty()) ::unlink(file_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  void keep() { file_.clear(); }

 private:
  std::string file_;
};

[[noreturn]] void refuse_read(const std::string& file, const std::string& cause) {
  throw InputError(file, "cannot be read: " + cause, "check the path and the permission to read it");
}

[[noreturn]] void refuse_write(const std::string& file, const std::string& cause) {
  throw InputError(file, "cannot be written: " + cause, "check the folder, its permissions and the free space");
}

std::string last_error() { return std::strerror(errno); }

// Reads to the end; a file that passes the limit is reported as EFBIG.
bool read_all(int descriptor, std::string& content) {
  std::size_t size = content.size();
  for (;;) {
    if (size == content.size()) content.resize(size + (std::size_t{1} << 16) + size / 2);
    const ssize_t got = ::read(descriptor, content.data() + size, content.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return false;
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
    if (size > kLargestFile) {
      errno = EFBIG;
      return false;
    }
  }
  content.resize(size);
  return true;
}

bool write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t put = ::write(descriptor, content.data(), content.size());
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) return false;
    content.remove_prefix(static_cast<std::size_t>(put));
  }
  return true;
}

// "-o /dev/stdout" means the open stream, also where the shell made it a file: replacing that file would leave the
// shell writing into the old one.
bool is_open_stream(const std::string& file) {
  return file == "/dev/stdout" || file == "/dev/stderr" || file.starts_with("/dev/fd/") ||
         file.starts_with("/proc/self/fd/");
}

void write_directly(const std::string& file, std::string_view content) {
  Descriptor target(::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  if (!target.open() || !write_all(target.number(), content) || !target.close()) refuse_write(file, last_error());
}

// Following links, so that a link to a file stays a link.
std::string resolved(const std::string& file) {
  char* path = ::realpath(file.c_str(), nullptr);
  if (path == nullptr) return file;
  std::string result(path);
  std::free(path);
  return result;
}

std::string folder_of(const std::string& file) {
  const std::size_t slash = file.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : file.substr(0, slash);
}

bool holds(const std::string& file, const struct stat& status, std::string_view content) {
  if (static_cast<std::size_t>(status.st_size) != content.size()) return false;
  const Descriptor source(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  std::string old;
  return source.open() && read_all(source.number(), old) && old == content;
}

// A new file beside the target, its name in `name`. open() and not mkstemp(): the umask and the folder's defaults
// apply.
int open_temporary(const std::string& folder, std::string& name) {
  static std::atomic<unsigned> counter{0};
  for (int attempt = 0; attempt < 1000; ++attempt) {
    name = folder + "/.foresight-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp";
    const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
  return -1;
}

// status: of the file to be replaced, or null.
void replace(const std::string& file, const std::string& target, std::string_view content, const struct stat* status) {
  const std::string folder = folder_of(target);
  std::string name;
  Descriptor descriptor(open_temporary(folder, name));
  if (!descriptor.open()) refuse_write(file, last_error());
  TemporaryFile temporary(name);
  if (status != nullptr && ::fchmod(descriptor.number(), status->st_mode & 07777U) != 0)
    refuse_write(file, last_error());
  if (!write_all(descriptor.number(), content) || ::fsync(descriptor.number()) != 0 || !descriptor.close() ||
      ::rename(name.c_str(), target.c_str()) != 0) {
    refuse_write(file, last_error());
  }
  temporary.keep();
  // The file is in place; the folder's sync only makes the new name last through a power cut, and some file systems
  // do not offer it.
  const Descriptor synced(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (synced.open()) ::fsync(synced.number());
}

}  // namespace

bool write_file_atomically(const std::string& file, std::string_view content) {
  if (file.empty()) throw InputError("(no name)", "the output has an empty name", "name a file to write");
  struct stat status {};
  const bool exists = ::stat(file.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) throw InputError(file, "is a folder", "name a file to write");
  if (exists && (is_open_stream(file) || !S_ISREG(status.st_mode))) {
    write_directly(file, content);
    return true;
  }
  if (!exists && errno != ENOENT) refuse_write(file, last_error());
  if (!exists && ::access(folder_of(file).c_str(), F_OK) != 0) {
    throw InputError(file, "its folder does not exist", "create the folder " + folder_of(file));
  }
  if (exists && holds(file, status, content)) return false;
  // A rename would pass over the file's own protection.
  if (exists && ::access(file.c_str(), W_OK) != 0) refuse_write(file, last_error());
  replace(file, exists ? resolved(file) : file, content, exists ? &status : nullptr);
  return true;
}

std::string read_whole_file(const std::string& file) {
  const Descriptor source(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (!source.open() && errno == ENOENT) throw InputError(file, "does not exist", "check the path");
  if (!source.open()) refuse_read(file, last_error());
  struct stat status {};
  if (::fstat(source.number(), &status) != 0) refuse_read(file, last_error());
  if (S_ISDIR(status.st_mode)) throw InputError(file, "is a folder", "name a file in it");
  if (status.st_size > static_cast<off_t>(kLargestFile)) refuse_read(file, "larger than 4 GiB");
  std::string content;
  // One byte more lets the first read() meet the end of the file without growing the text.
  content.reserve(static_cast<std::size_t>(status.st_size) + (std::size_t{1} << 16) + 1);
  if (!read_all(source.number(), content)) refuse_read(file, last_error());
  return content;
}

}  // namespace foresight
