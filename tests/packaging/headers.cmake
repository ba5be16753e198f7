# Checks that every header compiles on its own: one source per header, which includes nothing else. The build's compiler
# compiles it without precompiled headers, which would hide a missing #include, and without optimisation, since only
# errors and warnings matter. Not part of "all": the test Packaging.EveryHeaderCompilesOnItsOwn builds it and recompiles
# only what changed.
file(GLOB_RECURSE headers RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS
     ${PROJECT_SOURCE_DIR}/src/*.h ${PROJECT_SOURCE_DIR}/service/*.h ${PROJECT_SOURCE_DIR}/client/*.h
     ${PROJECT_SOURCE_DIR}/view/*.h ${PROJECT_SOURCE_DIR}/tests/*.h ${PROJECT_SOURCE_DIR}/bench/*.h)
# These headers are included several times in one source, each time for another processor or number type, which the
# source selects first.
list(FILTER headers EXCLUDE REGEX "-inl\\.h$")
# These need Python's own, which are searched for only where the module is built.
list(FILTER headers EXCLUDE REGEX "^src/python/")
# The benchmarks' libraries are searched for only with that option.
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
target_include_directories(buoyancy_headers PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/bench)
# The headers need the include folders of these targets, including generated ones.
target_link_libraries(buoyancy_headers PRIVATE buoyancy_cli buoyancy_bot_core buoyancy::lcmtypes GTest::gtest
                                               rapidcheck nlohmann_json::nlohmann_json spdlog::spdlog hwy::hwy
                                               buoyancy_compile_options)

# Ninja must run only once at a time in a build folder, so the test shares the lock of the tests that install from it.
# It compiles some 200 sources, a hundred times the work of another test: beside other builds it needs more time.
math(EXPR headers_timeout "4 * ${BUOYANCY_TEST_TIMEOUT}")
add_test(NAME Packaging.EveryHeaderCompilesOnItsOwn COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/headers_compile_alone
                                                            ${CMAKE_BINARY_DIR})
set_tests_properties(Packaging.EveryHeaderCompilesOnItsOwn
                     PROPERTIES TIMEOUT ${headers_timeout} LABELS "packaging;slow" PROCESSORS 2
                                RESOURCE_LOCK installation)
