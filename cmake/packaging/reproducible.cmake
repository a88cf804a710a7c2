# Read by cpack before it makes a package: the time of everything in it, unless SOURCE_DATE_EPOCH says another, is that of
# debian/changelog.in.
if(NOT DEFINED ENV{SOURCE_DATE_EPOCH})
  file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/debian/changelog.in dates REGEX "^ -- ")
  list(GET dates 0 date)
  string(REGEX REPLACE "^.*  [A-Za-z]+, " "" date "${date}")
  execute_process(COMMAND date -u -d "${date}" +%s OUTPUT_VARIABLE epoch OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  set(ENV{SOURCE_DATE_EPOCH} ${epoch})
endif()
