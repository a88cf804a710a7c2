# What every target of this project is built with.
include_guard()

function(foresight_target name)
  target_compile_features(${name} PUBLIC cxx_std_20)
  set_target_properties(${name} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  # Same bits on every machine: no fused multiply-add where the compiler feels like it.
  target_compile_options(${name} PRIVATE -ffp-contract=off -Wall -Wextra -Wshadow -Wpedantic -Wnon-virtual-dtor -Wold-style-cast)
  if(PROJECT_IS_TOP_LEVEL)
    target_compile_options(${name} PRIVATE -Werror)
  endif()
  if(FORESIGHT_SANITIZE)
    target_compile_options(${name} PRIVATE -fsanitize=${FORESIGHT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    target_link_options(${name} PUBLIC -fsanitize=${FORESIGHT_SANITIZE})
  endif()
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
endfunction()

# Programs link protobuf-lite unless they need the text format: one of the two, never both, in a process.
define_property(TARGET PROPERTY FORESIGHT_FULL_PROTOBUF BRIEF_DOCS "Link full Protocol Buffers instead of the lite library")

# Programs that no shared library is loaded for. foresight_linked: what stands in a list of libraries for one of two.
define_property(TARGET PROPERTY FORESIGHT_STATIC BRIEF_DOCS "Link static libraries only")
function(foresight_linked result shared static)
  set(${result} "$<IF:$<BOOL:$<TARGET_PROPERTY:FORESIGHT_STATIC>>,${static},${shared}>" PARENT_SCOPE)
endfunction()
function(foresight_link_statically name)
  set_target_properties(${name} PROPERTIES FORESIGHT_STATIC ON)
  target_link_options(${name} PRIVATE -static -Wl,--gc-sections)
endfunction()
