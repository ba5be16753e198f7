# What results are compared with: exact_oracle.h in rational, ball and dual numbers, and for loads in waves, which are no
# rational numbers, reference_load.h in extended precision. Neither uses a solver. Their functions are compiled here once,
# since instantiating them in every source that uses them took a third of the tests' build time.
find_library(GMP_LIBRARY gmp REQUIRED)

# Holds the poses and meshes that tests and benchmarks share, too.
add_library(
  buoyancy_oracle STATIC
  ${CMAKE_CURRENT_LIST_DIR}/ball.cpp
  ${CMAKE_CURRENT_LIST_DIR}/exact_oracle.cpp
  ${CMAKE_CURRENT_LIST_DIR}/stiffness_autodiff.cpp
  ${CMAKE_CURRENT_LIST_DIR}/truth.cpp
  ${CMAKE_CURRENT_LIST_DIR}/wetted_moments_reference.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../hydrostatics/random_poses.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../hydrostatics/test_meshes.cpp)
target_include_directories(buoyancy_oracle PUBLIC ${PROJECT_SOURCE_DIR})
target_link_libraries(buoyancy_oracle PUBLIC buoyancy_hydrostatics Boost::headers ${GMP_LIBRARY} PRIVATE buoyancy_compile_options)

add_library(buoyancy_wave_reference STATIC ${CMAKE_CURRENT_LIST_DIR}/reference_load.cpp
                                           ${CMAKE_CURRENT_LIST_DIR}/reference_sea.cpp
                                           ${CMAKE_CURRENT_LIST_DIR}/reference_spline.cpp)
target_include_directories(buoyancy_wave_reference PUBLIC ${PROJECT_SOURCE_DIR})
target_link_libraries(buoyancy_wave_reference PUBLIC buoyancy::wave_loads PRIVATE hwy::hwy buoyancy_compile_options)

if(BUOYANCY_SANITIZER MATCHES "fuzzer")
  # With sanitizers the truth would take most of the fuzzer's time, and it is not the code under test.
  target_compile_options(buoyancy_oracle PRIVATE -fno-sanitize=all)
endif()
