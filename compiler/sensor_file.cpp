#include "compiler/sensor_file.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/dynamic_message.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/text_format.h>

#include <cassert>
#include <limits>
#include <memory>
#include <optional>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "runtime/database.h"
#include "schema/descriptors.h"

namespace foresight {
namespace {

namespace pb = google::protobuf;

constexpr const char* kSeeSchema = "see schema/foresight/v1/sensor.proto for the fields, models/sensors/ for examples";

// Keeps the first error: later ones often follow from it.
class FirstError : public pb::io::ErrorCollector {
 public:
  void AddError(int line, int column, const std::string& message) override {
    if (!text_.empty()) return;
    // Both count from 0; a negative line means the message as a whole.
    if (line >= 0) text_ = "line " + std::to_string(line + 1) + ", column " + std::to_string(column + 1) + ": ";
    text_ += message;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// The generated code is lite and knows no names; so the text is read into a message built from the descriptors.
class SensorMessage {
 public:
  SensorMessage() {
    pb::FileDescriptorSet files;
    const std::string_view bytes = schema_descriptors();
    [[maybe_unused]] const bool parsed = files.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
    assert(parsed);
    for (const pb::FileDescriptorProto& file : files.file()) pool_.BuildFile(file);
    const pb::Descriptor* type = pool_.FindMessageTypeByName("foresight.v1.SensorModel");
    assert(type != nullptr);
    message_.reset(factory_.GetPrototype(type)->New());
  }
  [[nodiscard]] pb::Message& operator*() { return *message_; }

 private:
  pb::DescriptorPool pool_;
  pb::DynamicMessageFactory factory_{&pool_};
  std::unique_ptr<pb::Message> message_;  // before the factory ends
};

// proto3 does not tell a missing number from 0; neither is a sensor's name, size, focal length or distance.
void check_given(const pb::Message& message, const std::string& prefix, std::initializer_list<const char*> names,
                 const std::string& file) {
  for (const char* name : names) {
    const pb::FieldDescriptor* field = message.GetDescriptor()->FindFieldByName(name);
    assert(field != nullptr);
    if (!message.GetReflection()->HasField(message, field))
      throw InputError(file, prefix + name + " is missing, empty or 0", kSeeSchema);
  }
}

void check_given(const pb::Message& sensor, const std::string& file) {
  check_given(sensor, "", {"name", "camera", "nearest_distance_mm", "farthest_distance_mm"}, file);
  const pb::FieldDescriptor* field = sensor.GetDescriptor()->FindFieldByName("camera");
  const pb::Message& camera = sensor.GetReflection()->GetMessage(sensor, field);
  check_given(camera, "camera.", {"rows", "columns", "fx", "fy", "cx", "cy"}, file);
  const pb::OneofDescriptor* incidence = sensor.GetDescriptor()->FindOneofByName("largest_incidence");
  if (!sensor.GetReflection()->HasOneof(sensor, incidence))
    throw InputError(file, "largest_incidence_deg is missing", kSeeSchema);
}

}  // namespace

SensorModel parse_sensor(std::string_view text, const std::string& file) {
  if (text.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw InputError(file, "this is no sensor file, it is larger than 2 GB", kSeeSchema);
  SensorMessage sensor;
  FirstError error;
  pb::TextFormat::Parser parser;
  parser.RecordErrorsTo(&error);
  pb::io::ArrayInputStream input(text.data(), static_cast<int>(text.size()));
  if (!parser.Parse(&input, &*sensor)) throw InputError(file, error.text(), kSeeSchema);
  check_given(*sensor, file);
  std::optional<SensorModel> model = decode_sensor((*sensor).SerializeAsString());
  if (!model) throw InputError(file, "a text in it is not UTF-8", "write the name in UTF-8 or plain ASCII");
  check(*model, file);
  return *model;
}

SensorModel read_sensor_file(const std::string& file) { return parse_sensor(read_whole_file(file), file); }

SensorModel paper_sensor() {
  SensorModel sensor;
  sensor.name = "paper";
  sensor.camera = {240, 256, 769.23, 769.23, 127.5, 119.5};  // 900 mm / 1.17 mm per cell
  sensor.projector.reset();
  sensor.nearest_distance = sensor.farthest_distance = 900.0;
  sensor.depth_quantization = 0.1;
  sensor.depth_noise = 0.0;
  sensor.largest_incidence = 1.5707963267948966;
  sensor.background = false;
  return sensor;
}

}  // namespace foresight
