# Precompiled headers: other projects' headers that many of our sources include, parsed once instead of once per source.
# They save compile time and nothing else: every source still includes what it uses, and
# -DBUOYANCY_PRECOMPILED_HEADERS=OFF builds the same programs. Included last, when all targets are known.
set(standard_headers
    <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional> <memory> <mutex>
    <optional> <sstream> <string> <string_view> <thread> <utility> <vector> <Eigen/Geometry> <tl/expected.hpp>)

# buoyancy_precompiled_headers(<kind> HEADERS ... LIBRARIES ...): the target whose headers all targets of a kind reuse.
function(buoyancy_precompiled_headers kind)
  cmake_parse_arguments(ARG "" "" "HEADERS;LIBRARIES" ${ARGN})
  set(source ${CMAKE_BINARY_DIR}/precompiled_${kind}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// Nothing but the precompiled headers.\n")
  add_library(buoyancy_precompiled_${kind} OBJECT ${source})
  target_link_libraries(buoyancy_precompiled_${kind} PRIVATE Eigen3::Eigen tl::expected ${ARG_LIBRARIES}
                                                             buoyancy_compile_options)
  target_precompile_headers(buoyancy_precompiled_${kind} PRIVATE ${standard_headers} ${ARG_HEADERS})
endfunction()

# Of one kind are targets that are compiled with the same options and the same definitions of what the headers read.
buoyancy_precompiled_headers(library)
set_target_properties(buoyancy_precompiled_library PROPERTIES POSITION_INDEPENDENT_CODE ON)
buoyancy_precompiled_headers(
  program
  HEADERS <nlohmann/json.hpp>
  LIBRARIES nlohmann_json::nlohmann_json)
if(BUOYANCY_BUILD_TESTS)
  find_package(GTest REQUIRED)
  buoyancy_precompiled_headers(test HEADERS <gtest/gtest.h> <random> <nlohmann/json.hpp>
                               LIBRARIES GTest::gtest nlohmann_json::nlohmann_json)
endif()

# Whether a library, or one that it links, makes those who link it generate other code. g++ takes such options from where
# a header was precompiled, and does not always say so.
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

# Reuses them in the targets of a folder and those below it that are compiled with our options.
function(buoyancy_reuse_precompiled_headers folder)
  get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(below ${folders})
    buoyancy_reuse_precompiled_headers(${below})
  endforeach()
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  get_property(options_of_all DIRECTORY ${folder} PROPERTY COMPILE_OPTIONS)
  foreach(target ${targets})
    get_target_property(type ${target} TYPE)
    get_target_property(libraries ${target} LINK_LIBRARIES)
    get_target_property(options ${target} COMPILE_OPTIONS)
    if(NOT type MATCHES "^(EXECUTABLE|STATIC_LIBRARY)$" OR NOT "${libraries}" MATCHES "buoyancy_compile_options")
      continue()
    endif()
    if(options AND NOT "${options}" STREQUAL "${options_of_all}")
      continue()  # it is compiled otherwise
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
    if("${libraries}" MATCHES "GTest::")
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
