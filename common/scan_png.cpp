// Grey and colour PNGs through libpng.
#include <png.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <csetjmp>
#include <memory>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/scan_file.h"
#include "common/scan_format.h"

namespace foresight {
namespace {

using scan_format::kMendDamaged;

constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
constexpr std::size_t kHeaderEnd = 33;  // signature and the whole IHDR chunk

struct Source {
  std::string_view rest;
  std::string error;
};

// libpng reports through callbacks and a long jump. No object with a destructor may live between setjmp() and the jump:
// the functions that call libpng take everything they need from outside.
void keep_error(png_structp png, png_const_charp message) {
  auto* text = static_cast<std::string*>(png_get_error_ptr(png));
  try {
    *text = message;
  } catch (...) {  // no memory for a message: the jump alone says enough
  }
  png_longjmp(png, 1);
}

void ignore_warning(png_structp /*png*/, png_const_charp /*message*/) {}

void read_bytes(png_structp png, png_bytep bytes, std::size_t count) {
  auto* source = static_cast<Source*>(png_get_io_ptr(png));
  if (count > source->rest.size()) png_error(png, "it is cut short");
  std::copy_n(source->rest.data(), count, reinterpret_cast<char*>(bytes));
  source->rest.remove_prefix(count);
}

void append_bytes(png_structp png, png_bytep bytes, std::size_t count) {
  auto* target = static_cast<std::string*>(png_get_io_ptr(png));
  try {
    target->append(reinterpret_cast<const char*>(bytes), count);
  } catch (...) {  // no exception may cross libpng
    png_error(png, "out of memory");
  }
}

void flush_nothing(png_structp /*png*/) {}

// rows: pointers to as many rows as the header says. False with source.error set.
bool read_rows(Source& source, png_bytep* rows) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source.error, keep_error, ignore_warning);
  if (png == nullptr) return false;
  png_infop info = png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_read_struct(&png, &info, nullptr);
    return false;
  }
  png_set_user_limits(png, kLargestImageSide, kLargestImageSide);
  png_set_read_fn(png, &source, read_bytes);
  png_read_info(png, info);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  png_destroy_read_struct(&png, &info, nullptr);
  return true;
}

struct Layout {
  int rows;
  int columns;
  int bits;
  int color_type;
};

bool write_rows(const Layout& layout, png_bytep* rows, std::string& content, std::string& error) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &error, keep_error, ignore_warning);
  if (png == nullptr) return false;
  png_infop info = png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, &content, append_bytes, flush_nothing);
  png_set_IHDR(png, info, static_cast<png_uint_32>(layout.columns), static_cast<png_uint_32>(layout.rows), layout.bits,
               layout.color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  png_write_image(png, rows);
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return true;
}

std::vector<png_bytep> row_pointers(std::string& bytes, int rows, std::size_t row_bytes) {
  std::vector<png_bytep> pointers;
  for (int row = 0; row < rows; ++row) {
    pointers.push_back(reinterpret_cast<png_bytep>(bytes.data()) + static_cast<std::size_t>(row) * row_bytes);
  }
  return pointers;
}

// pixels: as PNG stores them, row by row, 16-bit values high byte first.
void write_png(const std::string& file, const Layout& layout, std::string pixels) {
  std::string content;
  std::string error;
  auto pointers = row_pointers(pixels, layout.rows, pixels.size() / static_cast<std::size_t>(layout.rows));
  if (!write_rows(layout, pointers.data(), content, error)) {
    throw InputError(file, "cannot be encoded as PNG: " + error, "give an image of a smaller size");
  }
  write_file_atomically(file, content);
}

// 16 bits a value where one needs it.
void write_grey(const std::string& file, int rows, int columns, std::span<const int> values, int bits) {
  std::string pixels;
  pixels.reserve(values.size() * static_cast<std::size_t>(bits / 8));
  for (const int value : values) {
    if (bits == 16) pixels += static_cast<char>(value >> 8);
    pixels += static_cast<char>(value & 0xFF);
  }
  write_png(file, {rows, columns, bits, PNG_COLOR_TYPE_GRAY}, std::move(pixels));
}

int big_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return static_cast<int>(std::min<std::uint32_t>(value, 0x7FFFFFFFU));
}

}  // namespace

bool scan_format::is_png(std::string_view bytes) { return bytes.starts_with(kSignature); }

scan_format::GreyImage scan_format::decode_grey_png(const std::string& file, std::string_view bytes) {
  if (!is_png(bytes)) throw InputError(file, "is no PNG file", "give a grey PNG");
  if (bytes.size() < kHeaderEnd) throw InputError(file, "it is cut short", kMendDamaged);
  // The header first, by hand: libpng would refuse a size, and convert a colour, without saying so in plain words.
  GreyImage image;
  image.columns = big_endian(bytes, 16, 4);
  image.rows = big_endian(bytes, 20, 4);
  image.bits = big_endian(bytes, 24, 1);
  const int color_type = big_endian(bytes, 25, 1);
  if (color_type != PNG_COLOR_TYPE_GRAY || (image.bits != 8 && image.bits != 16)) {
    throw InputError(file, "its pixels are not plain grey of 8 or 16 bits",
                     "convert it to a grey PNG, 16-bit for depths");
  }
  if (image.columns < 1 || image.rows < 1 || image.columns > kLargestImageSide || image.rows > kLargestImageSide) {
    throw InputError(file,
                     "its size of " + std::to_string(image.columns) + "x" + std::to_string(image.rows) +
                         " is outside 1x1 to 4096x4096",
                     "crop or thin the image");
  }
  const std::size_t row_bytes = static_cast<std::size_t>(image.columns) * static_cast<std::size_t>(image.bits / 8);
  std::string pixels(row_bytes * static_cast<std::size_t>(image.rows), '\0');
  auto pointers = row_pointers(pixels, image.rows, row_bytes);
  Source source{bytes, {}};
  if (!read_rows(source, pointers.data())) {
    throw InputError(file, "its PNG data is damaged: " + source.error, kMendDamaged);
  }
  const std::size_t step = static_cast<std::size_t>(image.bits / 8);
  image.values.reserve(pixels.size() / step);
  for (std::size_t at = 0; at < pixels.size(); at += step) image.values.push_back(big_endian(pixels, at, step));
  return image;
}

std::vector<int> read_grey_png(const std::string& file, int& rows, int& columns) {
  scan_format::GreyImage image = scan_format::decode_grey_png(file, read_whole_file(file));
  rows = image.rows;
  columns = image.columns;
  return std::move(image.values);
}

void write_depth_png(const std::string& file, const RangeImage& image, double depth_scale) {
  assert(image.points.size() == static_cast<std::size_t>(image.size()) && image.size() > 0);
  if (!std::isfinite(depth_scale) || !(depth_scale > 0.0)) {
    throw InputError(file, "a depth_scale of " + std::to_string(depth_scale),
                     "give a depth_scale above 0 mm per count");
  }
  std::vector<int> counts;
  counts.reserve(image.points.size());
  for (const Eigen::Vector3f& point : image.points) {
    const double count = point.z() > 0.0F ? std::round(static_cast<double>(point.z()) / depth_scale) : 0.0;
    if (count > 65535.0) {
      throw InputError(file, "a depth of " + std::to_string(point.z()) + " mm does not fit 16 bits",
                       "give a depth_scale of at least " + std::to_string(point.z() / 65535.0F));
    }
    if (count < 1.0 && point.z() > 0.0F) {
      throw InputError(file, "a depth of " + std::to_string(point.z()) + " mm would become 0, which means invalid",
                       "give a smaller depth_scale");
    }
    counts.push_back(static_cast<int>(count));
  }
  write_grey(file, image.rows, image.columns, counts, 16);
}

void write_label_png(const std::string& file, int rows, int columns, std::span<const int> labels) {
  assert(rows > 0 && columns > 0);
  assert(labels.size() == static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  const auto [low, high] = std::minmax_element(labels.begin(), labels.end());
  assert(*low >= 0 && *high <= 65535);
  static_cast<void>(low);
  write_grey(file, rows, columns, labels, *high <= 255 ? 8 : 16);
}

void write_rgb_png(const std::string& file, int rows, int columns, const std::vector<unsigned char>& rgb) {
  assert(rows > 0 && columns > 0);
  assert(rgb.size() == 3 * static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  write_png(file, {rows, columns, 8, PNG_COLOR_TYPE_RGB}, std::string(rgb.begin(), rgb.end()));
}

}  // namespace foresight
