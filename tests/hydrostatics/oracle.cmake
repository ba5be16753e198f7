# buoyancy_oracle: the exact oracle with its number types, and the poses and meshes that tests and benchmarks share. Its
# functions are compiled here once, since instantiating them in every source that uses them took a third of the tests'
# build time. The oracle uses no solver.
find_library(GMP_LIBRARY gmp REQUIRED)

add_library(
  buoyancy_oracle STATIC
  ${CMAKE_CURRENT_LIST_DIR}/ball.cpp
  ${CMAKE_CURRENT_LIST_DIR}/exact_oracle.cpp
  ${CMAKE_CURRENT_LIST_DIR}/random_poses.cpp
  ${CMAKE_CURRENT_LIST_DIR}/rational.cpp
  ${CMAKE_CURRENT_LIST_DIR}/stiffness_autodiff.cpp
  ${CMAKE_CURRENT_LIST_DIR}/test_meshes.cpp
  ${CMAKE_CURRENT_LIST_DIR}/truth.cpp
  ${CMAKE_CURRENT_LIST_DIR}/wetted_moments_reference.cpp)
target_include_directories(buoyancy_oracle PUBLIC ${PROJECT_SOURCE_DIR})
target_link_libraries(buoyancy_oracle PUBLIC buoyancy_hydrostatics ${GMP_LIBRARY} PRIVATE buoyancy_compile_options)
