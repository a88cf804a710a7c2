# Steps of the build of a database, run in the folder of its parts by what foresight_add_database() sets up.
#   cmake -DSTEP=link -DPROGRAM=foresightc -DDATABASE=out.fdb -P ForesightDatabaseStep.cmake     parts.txt to DATABASE
#   cmake -DSTEP=forget -DDATABASE=out.fdb -P ForesightDatabaseStep.cmake     stamps of files that are gone
cmake_minimum_required(VERSION 3.20)
file(STRINGS parts.txt parts)

if(STEP STREQUAL "link")
  execute_process(COMMAND ${PROGRAM} link ${parts} -o ${DATABASE} RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "foresightc link ended with ${code}")
  endif()
elseif(STEP STREQUAL "forget")
  foreach(part IN LISTS parts)
    if(NOT EXISTS ${part})
      file(REMOVE ${part}.stamp)
    endif()
  endforeach()
  if(NOT EXISTS ${DATABASE})
    file(REMOVE linked.stamp)
  endif()
endif()
