// The compiled description of sensor.proto and database.proto, for reading messages from text. Only the compiler links
// it: the generated code is lite and knows no field names.
#pragma once

#include <string_view>

namespace foresight {

// A serialized google.protobuf.FileDescriptorSet.
[[nodiscard]] std::string_view schema_descriptors();

}  // namespace foresight
