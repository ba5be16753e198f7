# Every header compiles on its own: one source per header, which includes it and nothing else, compiled by the build's
# compiler without precompiled headers, which would hide a missing #include, and without optimisation, since only
# errors and warnings are of interest. Not part of "all": the test Project.EveryHeaderCompilesOnItsOwn builds it, and
# compiles again only what changed since.
file(GLOB_RECURSE headers RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS
     ${PROJECT_SOURCE_DIR}/src/*.h ${PROJECT_SOURCE_DIR}/service/*.h ${PROJECT_SOURCE_DIR}/client/*.h
     ${PROJECT_SOURCE_DIR}/view/*.h ${PROJECT_SOURCE_DIR}/tests/*.h ${PROJECT_SOURCE_DIR}/bench/*.h)
# These are included several times in one source, each time for another processor or kind of number, by sources that
# say first which.
list(FILTER headers EXCLUDE REGEX "-inl\\.h$")
# Their own libraries are looked for only with that option.
if(NOT BUOYANCY_BUILD_BENCH)
  list(FILTER headers EXCLUDE REGEX "^bench/")
endif()

set(sources "")
foreach(header ${headers})
  set(source ${CMAKE_CURRENT_BINARY_DIR}/headers/${header}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "#include \"${header}\"\n")
  list(APPEND sources ${source})
endforeach()
add_library(buoyancy_headers OBJECT EXCLUDE_FROM_ALL ${sources})
target_compile_features(buoyancy_headers PRIVATE cxx_std_20)
target_compile_options(buoyancy_headers PRIVATE -O0 -g0 -Werror)
# Programs and folders that headers of tests and benchmarks name, as the targets that include them define them.
foreach(name BUOYANCYD BUOYANCY_PICTURES BUOYANCY_REPLAY BUOYANCY_REPORT BUOYANCY_SOURCE_DIR BUOYANCY_VIEW BULLET_CRATE
             LCM_ECHO)
  target_compile_definitions(buoyancy_headers PRIVATE "${name}=\"\"")
endforeach()
target_include_directories(buoyancy_headers PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/bench)
# Whose folders of headers they need, generated ones included.
target_link_libraries(buoyancy_headers PRIVATE buoyancy_cli buoyancy_bot_core buoyancy::lcmtypes GTest::gtest
                                               rapidcheck nlohmann_json::nlohmann_json spdlog::spdlog hwy::hwy
                                               buoyancy_compile_options)

# Ninja must run once at a time in a build folder: hence the lock of the tests that install from it.
add_test(NAME Project.EveryHeaderCompilesOnItsOwn COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/headers_compile_alone
                                                          ${CMAKE_BINARY_DIR})
set_tests_properties(Project.EveryHeaderCompilesOnItsOwn
                     PROPERTIES TIMEOUT ${BUOYANCY_TEST_TIMEOUT} LABELS "packaging;slow" PROCESSORS 2
                                RESOURCE_LOCK installation)
