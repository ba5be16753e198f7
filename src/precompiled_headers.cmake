# Precompiled headers: third-party headers that many sources include are parsed once instead of once per source. They
# only save compile time: every source still includes what it uses, and -DBUOYANCY_PRECOMPILED_HEADERS=OFF builds the
# same programs. A header is listed if most sources of its kind include it: each header costs every source time, since
# g++ instantiates again what the header's inline functions use, half a second for <nlohmann/json.hpp>. The top-level
# CMakeLists.txt includes this file last, when all targets are known.
set(standard_headers
    <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional> <memory> <mutex>
    <optional> <sstream> <string> <string_view> <thread> <utility> <vector> <Eigen/Geometry> <tl/expected.hpp>)

# buoyancy_precompiled_headers(<kind> HEADERS ... LIBRARIES ...) adds the target whose headers all targets of a kind reuse.
function(buoyancy_precompiled_headers kind)
  cmake_parse_arguments(ARG "" "" "HEADERS;LIBRARIES" ${ARGN})
  set(source ${CMAKE_BINARY_DIR}/precompiled_${kind}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// Nothing but the precompiled headers.\n")
  add_library(buoyancy_precompiled_${kind} OBJECT ${source})
  target_link_libraries(buoyancy_precompiled_${kind} PRIVATE Eigen3::Eigen tl::expected ${ARG_LIBRARIES}
                                                             buoyancy_compile_options)
  target_precompile_headers(buoyancy_precompiled_${kind} PRIVATE ${standard_headers} ${ARG_HEADERS})
endfunction()

# Targets of one kind are compiled with the same options and the same macro definitions.
buoyancy_precompiled_headers(library)
set_target_properties(buoyancy_precompiled_library PROPERTIES POSITION_INDEPENDENT_CODE ON)
buoyancy_precompiled_headers(program)
if(BUOYANCY_BUILD_TESTS)
  find_package(GTest REQUIRED)
  buoyancy_precompiled_headers(test HEADERS <gtest/gtest.h> <random> LIBRARIES GTest::gtest)
  target_compile_options(buoyancy_precompiled_test PRIVATE $<$<CONFIG:Release>:-O1>)  # see tests/CMakeLists.txt
endif()

# Sets <result> to whether a library, or one that it links, passes code generation options to its users. g++ applies the
# options with which a header was precompiled and does not always warn about a difference.
function(buoyancy_changes_code library result)
  set(${result} FALSE PARENT_SCOPE)
  if(NOT TARGET ${library} OR library STREQUAL buoyancy_compile_options)
    return()
  endif()
  get_target_property(options ${library} INTERFACE_COMPILE_OPTIONS)
  if(options MATCHES "(^|;)-[fmO]")
    set(${result} TRUE PARENT_SCOPE)
    return()
  endif()
  get_target_property(libraries ${library} INTERFACE_LINK_LIBRARIES)
  foreach(linked ${libraries})
    buoyancy_changes_code(${linked} found)
    if(found)
      set(${result} TRUE PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

# Reuses the precompiled headers in the targets of a folder and its subfolders that use buoyancy_compile_options.
function(buoyancy_reuse_precompiled_headers folder)
  get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(subfolder ${folders})
    buoyancy_reuse_precompiled_headers(${subfolder})
  endforeach()
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  get_property(folder_options DIRECTORY ${folder} PROPERTY COMPILE_OPTIONS)
  foreach(target ${targets})
    get_target_property(type ${target} TYPE)
    get_target_property(libraries ${target} LINK_LIBRARIES)
    get_target_property(options ${target} COMPILE_OPTIONS)
    if(NOT type MATCHES "^(EXECUTABLE|STATIC_LIBRARY)$" OR NOT "${libraries}" MATCHES "buoyancy_compile_options")
      continue()
    endif()
    if(options AND NOT "${options}" STREQUAL "${folder_options}")
      continue()  # the target has compile options of its own
    endif()
    set(changed FALSE)
    foreach(library ${libraries})
      buoyancy_changes_code(${library} changed)
      if(changed)
        break()
      endif()
    endforeach()
    if(changed)
      continue()
    endif()
    get_target_property(position_independent ${target} POSITION_INDEPENDENT_CODE)
    if(folder MATCHES "^${PROJECT_SOURCE_DIR}/tests")  # compiled with -O1
      if(NOT "${libraries}" MATCHES "GTest::")
        continue()  # too few for a kind of their own
      endif()
      set(kind test)
    elseif(position_independent)
      set(kind library)
    else()
      set(kind program)
    endif()
    target_precompile_headers(${target} REUSE_FROM buoyancy_precompiled_${kind})
  endforeach()
endfunction()
buoyancy_reuse_precompiled_headers(${PROJECT_SOURCE_DIR})
