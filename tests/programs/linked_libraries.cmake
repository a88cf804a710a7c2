# The runtime is lean: fails when PROGRAM links, directly or through another library, what only the compiler may.
#   cmake -DPROGRAM=foresight -P linked_libraries.cmake
file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${PROGRAM} RESOLVED_DEPENDENCIES_VAR found UNRESOLVED_DEPENDENCIES_VAR missing)
if(NOT "${found};${missing}" MATCHES "libstdc\\+\\+|libc\\+\\+")
  message(FATAL_ERROR "${PROGRAM}: its libraries cannot be listed")
endif()
set(heavy ${found} ${missing})
# Full Protocol Buffers are libprotobuf.so; libprotobuf-lite.so is welcome.
list(FILTER heavy INCLUDE REGEX "/?lib(embree|OpenMesh|tbb|crypto|ssl|protobuf\\.|protoc)")
if(heavy)
  message(FATAL_ERROR "${PROGRAM} links ${heavy}")
endif()
