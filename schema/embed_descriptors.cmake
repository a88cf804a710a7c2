# Writes the bytes of INPUT as the C++ source OUTPUT that defines schema_descriptors().
file(READ ${INPUT} hex HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
string(REGEX REPLACE "((0x..,){20})" "\\1\n    " bytes "${bytes}")
file(WRITE ${OUTPUT} "#include \"schema/descriptors.h\"

namespace foresight {
namespace {
constexpr unsigned char kBytes[] = {
    ${bytes}};
}  // namespace

std::string_view schema_descriptors() { return {reinterpret_cast<const char*>(kBytes), sizeof(kBytes)}; }

}  // namespace foresight
")
