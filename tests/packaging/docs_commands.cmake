# One test per page of the documentation that has a ```sh block: every such block runs (docs_commands).
file(GLOB pages CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/*.md)
list(APPEND pages ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${pages})  # which pages have a block
foreach(page IN LISTS pages)
  file(STRINGS ${page} blocks REGEX "^```sh$")
  if(NOT blocks)
    continue()
  endif()
  get_filename_component(name ${page} NAME_WE)
  set(test Docs.CommandsRun/${name})
  add_test(NAME ${test} COMMAND ${PROJECT_SOURCE_DIR}/scripts/in_network_namespace
                                ${CMAKE_CURRENT_SOURCE_DIR}/docs_commands ${page} ${CMAKE_BINARY_DIR})
  set_tests_properties(${test} PROPERTIES TIMEOUT ${BUOYANCY_TEST_TIMEOUT} LABELS packaging
                                          SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\] network")
endforeach()
# The README installs from this build, which writes a manifest into it.
set_tests_properties(Docs.CommandsRun/README PROPERTIES LABELS "packaging;slow" RESOURCE_LOCK installation)
