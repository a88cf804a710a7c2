# foresight_add_database(NAME <name> MODELS <cad>... [SENSOR <textproto>] [OUTPUT <database>] [OPTIONS <option>...] [EMBED])
#
# A target <name>, part of `all`, that keeps a database up to date: every CAD file is compiled by a command of its own, with
# a dependency file, and what comes out is linked into OUTPUT (default: <name>.fdb in the current build folder). OUTPUT in
# full is left in the variable <name>_DATABASE. Relative CAD and sensor files are looked for in the current source folder.
# Without SENSOR it is the paper's. OPTIONS go to every `foresightc compile`; unless they say otherwise each uses one thread,
# since the build runs many.
#
# EMBED also gives the static library <name>_embedded with the database in its read-only data (GCC or Clang, ELF), and
# <name>_database.h, which a program that links it includes:
#   foresight::Recognizer recognizer(foresight::DatabaseBytes{<name>_database, <name>_database_size});
#
# A part or a database with the content it had before keeps its time, and nothing that depends on it is done again. So it
# cannot be what tells the build that the command ran: a stamp beside it is, and it is the stamp's byproduct.
include_guard(GLOBAL)
cmake_policy(PUSH)
cmake_policy(VERSION 3.20...3.25)

# Ends the configuration unless foresightc is there and runs on this machine.
function(_foresight_check_compiler)
  if(NOT TARGET Foresight::compiler)
    message(FATAL_ERROR "foresight_add_database: there is no foresightc for this machine; "
      "install it (Debian: foresight-compiler), or name it with -DForesight_COMPILER=PROGRAM")
  endif()
  get_target_property(imported Foresight::compiler IMPORTED)
  get_property(checked GLOBAL PROPERTY _foresight_compiler_checked)
  if(checked OR NOT imported)
    return()
  endif()
  get_target_property(program Foresight::compiler IMPORTED_LOCATION)
  execute_process(COMMAND ${program} --version RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "foresight_add_database: ${program} does not run on this machine (${code}); "
      "name a foresightc that does with -DForesight_COMPILER=PROGRAM")
  endif()
  set_property(GLOBAL PROPERTY _foresight_compiler_checked TRUE)
endfunction()

# Writes only what changed: what depends on it is done again just then.
function(_foresight_write_list file)
  list(JOIN ARGN "\n" content)
  file(CONFIGURE OUTPUT ${file} CONTENT "@content@\n" @ONLY)
endfunction()

function(_foresight_embed name database folder)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang" OR WIN32 OR APPLE)
    message(FATAL_ERROR "foresight_add_database: EMBED needs GCC or Clang, C++ and ELF")
  endif()
  if(NOT name MATCHES "^[A-Za-z_][A-Za-z0-9_]*$")
    message(FATAL_ERROR "foresight_add_database: with EMBED, NAME must be a C identifier, not ${name}")
  endif()
  configure_file(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/embedded_database.h.in ${folder}/include/${name}_database.h @ONLY)
  configure_file(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/embedded_database.cpp.in ${folder}/${name}_database.cpp @ONLY)
  add_library(${name}_embedded STATIC ${folder}/${name}_database.cpp)
  add_dependencies(${name}_embedded ${name})
  set_source_files_properties(${folder}/${name}_database.cpp PROPERTIES OBJECT_DEPENDS ${database})
  # Link-time optimization does not look into assembler and would miss the symbols.
  set_target_properties(${name}_embedded PROPERTIES INTERPROCEDURAL_OPTIMIZATION OFF)
  target_compile_options(${name}_embedded PRIVATE -fno-lto)
  target_include_directories(${name}_embedded INTERFACE ${folder}/include)
endfunction()

function(foresight_add_database)
  cmake_parse_arguments(PARSE_ARGV 0 ARG "EMBED" "NAME;SENSOR;OUTPUT" "MODELS;OPTIONS")
  if(NOT ARG_NAME OR NOT ARG_MODELS OR ARG_UNPARSED_ARGUMENTS OR ARG_KEYWORDS_MISSING_VALUES)
    message(FATAL_ERROR "foresight_add_database: give NAME and MODELS, and a value for each word; "
      "unknown: '${ARG_UNPARSED_ARGUMENTS}', without value: '${ARG_KEYWORDS_MISSING_VALUES}'")
  endif()
  _foresight_check_compiler()

  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${ARG_NAME}.parts)
  if(NOT ARG_OUTPUT)
    set(ARG_OUTPUT ${ARG_NAME}.fdb)
  endif()
  get_filename_component(database ${ARG_OUTPUT} ABSOLUTE BASE_DIR ${CMAKE_CURRENT_BINARY_DIR})
  set(options --progress none ${ARG_OPTIONS})
  if(NOT "--jobs" IN_LIST ARG_OPTIONS)
    list(PREPEND options --jobs 1)
  endif()
  if(ARG_SENSOR)
    get_filename_component(sensor ${ARG_SENSOR} ABSOLUTE)
    list(APPEND options --sensor ${sensor})
  endif()
  # Make does not look at how a command has changed, nor at which parts are gone: these files tell it.
  _foresight_write_list(${folder}/options.txt ${options})

  set(stems "")
  set(stamps "")
  set(parts "")
  foreach(model IN LISTS ARG_MODELS)
    get_filename_component(cad ${model} ABSOLUTE)
    get_filename_component(stem ${model} NAME_WLE)
    if(stem IN_LIST stems)
      message(FATAL_ERROR "foresight_add_database: two MODELS of ${ARG_NAME} are named ${stem}; objects are named after their files, which must differ")
    endif()
    list(APPEND stems ${stem})
    set(part ${folder}/${stem}.fdb)
    list(APPEND parts ${part})
    list(APPEND stamps ${part}.stamp)
    add_custom_command(
      OUTPUT ${part}.stamp
      BYPRODUCTS ${part}
      COMMAND Foresight::compiler compile ${cad} -o ${part} --depfile ${part}.d --depfile-target ${part}.stamp ${options}
      COMMAND ${CMAKE_COMMAND} -E touch ${part}.stamp
      DEPENDS ${cad} ${sensor} ${folder}/options.txt $<TARGET_FILE:Foresight::compiler>
      DEPFILE ${part}.d
      COMMENT "Compiling ${stem} for ${ARG_NAME}"
      VERBATIM)
  endforeach()
  add_custom_target(${ARG_NAME}_parts DEPENDS ${stamps})

  # Through a file: thousands of names are too many for one command line of a shell. The names stay short by a change of folder.
  list(TRANSFORM stems PREPEND ./ OUTPUT_VARIABLE names)
  list(TRANSFORM names APPEND .fdb)
  _foresight_write_list(${folder}/parts.txt ${names})
  set(step ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/ForesightDatabaseStep.cmake)
  add_custom_command(
    OUTPUT ${folder}/linked.stamp
    BYPRODUCTS ${database}
    COMMAND ${CMAKE_COMMAND} -DSTEP=link -DPROGRAM=$<TARGET_FILE:Foresight::compiler> -DDATABASE=${database} -P ${step}
    COMMAND ${CMAKE_COMMAND} -E touch linked.stamp
    DEPENDS ${parts} ${folder}/parts.txt $<TARGET_FILE:Foresight::compiler>
    WORKING_DIRECTORY ${folder}
    COMMENT "Linking database ${ARG_NAME}"
    VERBATIM)
  add_custom_target(${ARG_NAME} ALL DEPENDS ${folder}/linked.stamp)
  add_dependencies(${ARG_NAME} ${ARG_NAME}_parts)

  # Ninja knows byproducts and makes a deleted one again. Make sees the stamp only: a look before takes away what has no file.
  if(CMAKE_GENERATOR MATCHES "Makefiles")
    add_custom_target(${ARG_NAME}_lost
      COMMAND ${CMAKE_COMMAND} -DSTEP=forget -DDATABASE=${database} -P ${step} WORKING_DIRECTORY ${folder} VERBATIM)
    add_dependencies(${ARG_NAME}_parts ${ARG_NAME}_lost)
  endif()
  if(ARG_EMBED)
    _foresight_embed(${ARG_NAME} ${database} ${folder})
  endif()
  set(${ARG_NAME}_DATABASE ${database} PARENT_SCOPE)
endfunction()

cmake_policy(POP)
