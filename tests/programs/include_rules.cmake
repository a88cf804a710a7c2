# The picture of the folders as a test: which folder may include what. Fails with every line that may not stand.
#   cmake -DSOURCE=<source root> -P include_rules.cmake
set(wrong "")
set(lines_seen 0)

# Lines `#include ...` of the files matching a pattern, none of which may match the expression.
function(forbid pattern expression)
  file(GLOB files RELATIVE ${SOURCE} ${SOURCE}/${pattern})
  list(REMOVE_ITEM files ${ARGN})  # the exceptions
  if(NOT files)
    message(FATAL_ERROR "no files match ${pattern}")
  endif()
  foreach(file ${files})
    file(STRINGS ${SOURCE}/${file} includes REGEX "^[ \t]*#[ \t]*include")
    foreach(line ${includes})
      math(EXPR lines_seen "${lines_seen} + 1")
      if(line MATCHES "${expression}")
        string(APPEND wrong "\n  ${file}: ${line}")
      endif()
    endforeach()
  endforeach()
  set(wrong "${wrong}" PARENT_SCOPE)
  set(lines_seen ${lines_seen} PARENT_SCOPE)
endfunction()

set(compiler_only "<embree|<OpenMesh|<tbb/|<openssl/|\"compiler/|google/protobuf/(descriptor|dynamic_message|text_format|io/)")
foreach(folder schema common runtime)
  forbid("${folder}/*.h" "${compiler_only}")
  forbid("${folder}/*.cpp" "${compiler_only}")
endforeach()
foreach(kind h cpp)
  forbid("schema/*.${kind}" "\"runtime/|<flann")
  forbid("common/*.${kind}" "\"(runtime|schema)/|<flann|\\.pb\\.h|google/protobuf")
  forbid("compiler/*.${kind}" "<flann")
endforeach()

# Libraries stay behind the sources; what they need in a header would spread through the whole tree.
set(behind_sources "<embree|<OpenMesh|<flann|\\.pb\\.h|google/protobuf|<tbb/|<openssl/")
foreach(folder schema common runtime)
  forbid("${folder}/*.h" "${behind_sources}")
endforeach()
forbid("compiler/*.h" "${behind_sources}" compiler/embree.h)  # private to one source:
forbid("compiler/*.cpp" "\"compiler/embree\\.h\"" compiler/sensor_simulator.cpp)
forbid("compiler/*.h" "\"compiler/embree\\.h\"")

# One source each.
forbid("runtime/*.cpp" "\\.pb\\.h" runtime/database.cpp)
forbid("runtime/*.cpp" "<flann" runtime/nearest_data_point.cpp)
forbid("compiler/*.cpp" "<OpenMesh" compiler/cad_model.cpp)
forbid("compiler/*.cpp" "foresight/v1/.*\\.pb\\.h" compiler/database_writer.cpp)

# The public header asks for nothing but the standard library, whose headers have neither folder nor ending.
forbid("runtime/foresight.h" "\"|<[^>]*[/.]")
forbid("runtime/foresight_c.h" "\"|<[^s]|<s[^t]|<st[^d]|<std[^i]|<stdi[^n]")  # <stdint.h> alone

if(lines_seen LESS 500)
  message(FATAL_ERROR "only ${lines_seen} includes seen: the rules look in the wrong place")
endif()
if(wrong)
  message(FATAL_ERROR "includes that may not stand:${wrong}")
endif()
