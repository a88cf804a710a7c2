# `cpack` makes Debian packages: foresight-compiler, foresight-runtime and libforesight-dev, a component each of what is installed
# (cmake/ForesightInstall.cmake). Same build, same bytes: times in them are that of debian/changelog.in, or
# SOURCE_DATE_EPOCH where it is set (reproducible.cmake).
set(FORESIGHT_MAINTAINER "Foresight authors <foresight@example.org>" CACHE STRING "Who makes the Debian packages: Name <mail address>")
configure_file(${CMAKE_CURRENT_LIST_DIR}/debian/changelog.in ${PROJECT_BINARY_DIR}/package/changelog @ONLY)

# Manual pages and changelog stand compressed in a package. No name and time in them (-n): same text, same bytes.
find_program(GZIP_PROGRAM gzip)
mark_as_advanced(GZIP_PROGRAM)
set(compressed "")
function(foresight_install_compressed source destination name component)
  set(copy ${PROJECT_BINARY_DIR}/package/${component}/${name})
  add_custom_command(
    OUTPUT ${copy}.gz
    COMMAND ${CMAKE_COMMAND} -E copy ${source} ${copy}
    COMMAND ${GZIP_PROGRAM} -9nf ${copy}
    DEPENDS ${source} VERBATIM)
  set(compressed ${compressed} ${copy}.gz PARENT_SCOPE)
  install(FILES ${copy}.gz DESTINATION ${destination} COMPONENT ${component} ${ARGN})
endfunction()

set(packages runtime foresight-runtime development libforesight-dev)
set(programs runtime foresight)
if(FORESIGHT_BUILD_COMPILER)
  list(APPEND packages compiler foresight-compiler)
  list(APPEND programs compiler foresightc)
endif()

while(programs)
  list(POP_FRONT programs component program)
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/completions/${program} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT ${component})
  if(GZIP_PROGRAM)
    foresight_install_compressed(${CMAKE_CURRENT_LIST_DIR}/man/${program}.1 ${CMAKE_INSTALL_MANDIR}/man1 ${program}.1 ${component})
  else()
    install(FILES ${CMAKE_CURRENT_LIST_DIR}/man/${program}.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
  endif()
endwhile()
while(packages)
  list(POP_FRONT packages component package)
  string(TOUPPER ${component} COMPONENT)
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_NAME ${package})
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  # What Debian wants beside the files, in packages only.
  set(doc_dir ${CMAKE_INSTALL_DATADIR}/doc/${package})
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/debian/copyright DESTINATION ${doc_dir} COMPONENT ${component} EXCLUDE_FROM_ALL)
  if(GZIP_PROGRAM)
    foresight_install_compressed(${PROJECT_BINARY_DIR}/package/changelog ${doc_dir} changelog ${component} EXCLUDE_FROM_ALL)
  endif()
endwhile()
add_custom_target(foresight_documents ALL DEPENDS ${compressed})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME foresight)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # it would stand before each package's own
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_LIST_DIR}/reproducible.cmake)
set(CPACK_POST_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/repack.cmake)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${FORESIGHT_MAINTAINER})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMPILER_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMPILER_PACKAGE_SUGGESTS "foresight-runtime, parallel")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libprotobuf-dev (>= 3.21), liblz4-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "foresight-compiler")
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "recognize and localize known objects in range images
The program foresight finds the parts of a compiled database in range images
of a structured-light scanner or depth camera and tells their poses.")
set(CPACK_DEBIAN_COMPILER_DESCRIPTION "compile CAD models for recognition in range images
The program foresightc turns CAD models of parts with planar faces, and the
description of a scanner, into a database with which foresight recognizes the
parts in range images.")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "recognize known objects in range images (library)
The library behind the program foresight, for C++ programs: headers, a static
library, and what CMake and pkg-config need. CMake projects can also keep
databases of their CAD files up to date, with foresight-compiler.")
include(CPack)
