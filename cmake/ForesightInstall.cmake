# What `cmake --install` puts where, in three components: compiler, runtime, development. cmake/packaging makes a Debian
# package of each.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Foresight)
set(data_dir ${CMAKE_INSTALL_DATADIR}/foresight)

# The programs, with what they are used with.
install(TARGETS foresight RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
if(FORESIGHT_BUILD_COMPILER)
  install(TARGETS foresightc RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT compiler)
  install(DIRECTORY models/ DESTINATION ${data_dir}/models COMPONENT compiler
    FILES_MATCHING PATTERN "*.off" PATTERN "*.textproto")
  install(DIRECTORY scripts/farm/ DESTINATION ${data_dir}/farm COMPONENT compiler USE_SOURCE_PERMISSIONS)
endif()
install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/foresight COMPONENT development)
install(DIRECTORY schema/foresight DESTINATION ${data_dir}/schema COMPONENT development FILES_MATCHING PATTERN "*.proto")

# One archive for other people's programs: that the library consists of several, and which headers they use, stays inside.
add_library(foresight_archive STATIC
  $<TARGET_OBJECTS:foresight_runtime> $<TARGET_OBJECTS:foresight_schema> $<TARGET_OBJECTS:foresight_common>)
set_target_properties(foresight_archive PROPERTIES LINKER_LANGUAGE CXX OUTPUT_NAME foresight EXPORT_NAME runtime)
target_compile_features(foresight_archive INTERFACE cxx_std_17)  # what the public header asks for
target_include_directories(foresight_archive INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_link_libraries(foresight_archive INTERFACE
  $<INSTALL_INTERFACE:$<LINK_ONLY:protobuf::libprotobuf-lite>> $<INSTALL_INTERFACE:$<LINK_ONLY:Foresight::lz4>>)
install(TARGETS foresight_archive EXPORT ForesightTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(FILES runtime/foresight.h runtime/foresight_c.h common/errors.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/foresight COMPONENT development)

# find_package(Foresight)
install(EXPORT ForesightTargets NAMESPACE Foresight:: DESTINATION ${package_dir} COMPONENT development)
configure_package_config_file(cmake/ForesightConfig.cmake.in ${PROJECT_BINARY_DIR}/package/ForesightConfig.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS CMAKE_INSTALL_BINDIR NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/ForesightConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/package/ForesightConfig.cmake
  ${PROJECT_BINARY_DIR}/package/ForesightConfigVersion.cmake
  cmake/ForesightDatabase.cmake
  cmake/ForesightDatabaseStep.cmake
  cmake/embedded_database.cpp.in
  cmake/embedded_database.h.in
  DESTINATION ${package_dir} COMPONENT development)

# pkg-config --cflags --libs foresight. Relative to the file itself, so that an installed tree can be moved.
file(RELATIVE_PATH pc_to_prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" pc_to_prefix "${pc_to_prefix}")
file(RELATIVE_PATH pc_libdir ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_LIBDIR})
file(RELATIVE_PATH pc_includedir ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
configure_file(cmake/foresight.pc.in ${PROJECT_BINARY_DIR}/package/foresight.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/package/foresight.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
