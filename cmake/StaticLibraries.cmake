# The runtime's libraries once more, for static programs: interface targets foresight_static_*. FORESIGHT_HAS_STATIC_LIBRARIES
# says whether all are there.
find_library(STATIC_PROTOBUF_LITE libprotobuf-lite.a)
find_library(STATIC_PNG libpng.a)
find_library(STATIC_ZLIB libz.a)
find_library(STATIC_LZ4 liblz4.a)
find_file(LZF_DECOMPRESSOR lzf_d.c PATHS /usr/src/liblzf)  # Debian has no static liblzf, but its source, to be compiled in
mark_as_advanced(STATIC_PROTOBUF_LITE STATIC_PNG STATIC_ZLIB STATIC_LZ4 LZF_DECOMPRESSOR)

if(STATIC_PROTOBUF_LITE AND STATIC_PNG AND STATIC_ZLIB AND STATIC_LZ4 AND LZF_DECOMPRESSOR)
  set(FORESIGHT_HAS_STATIC_LIBRARIES ON)
  add_library(foresight_static_lzf STATIC ${LZF_DECOMPRESSOR})
  target_include_directories(foresight_static_lzf SYSTEM PRIVATE ${LIBLZF_INCLUDE_DIRS})
  target_compile_options(foresight_static_lzf PRIVATE -w)
else()
  set(FORESIGHT_HAS_STATIC_LIBRARIES OFF)
endif()

if(FORESIGHT_STATIC_RUNTIME AND (FORESIGHT_SANITIZE OR NOT FORESIGHT_HAS_STATIC_LIBRARIES))
  message(FATAL_ERROR "FORESIGHT_STATIC_RUNTIME: no sanitizers go with it, and it needs the static libraries in Debian's "
    "libprotobuf-dev, libpng-dev, zlib1g-dev and liblz4-dev, and the source in liblzf-dev")
endif()
