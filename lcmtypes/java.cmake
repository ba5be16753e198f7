# The message types as a Java archive, which lcm-spy needs to decode them (client/buoyancy-spy.in). Defines the target
# buoyancy_java_types if a Java compiler and LCM's jar are installed.
find_package(Java COMPONENTS Development QUIET)
set(java_packages "default-jdk-headless liblcm-java")
if(NOT Java_FOUND)
  message(STATUS "buoyancy-spy is not built: no Java compiler was found. On Debian: apt-get install ${java_packages}")
  return()
endif()
include(UseJava)
find_jar(LCM_JAR NAMES lcm)
if(NOT LCM_JAR)
  message(STATUS "buoyancy-spy is not built: lcm.jar was not found. On Debian: apt-get install ${java_packages}")
  return()
endif()

list(TRANSFORM types PREPEND ${CMAKE_CURRENT_BINARY_DIR}/java/buoyancy/ OUTPUT_VARIABLE java_sources)
list(TRANSFORM java_sources APPEND .java)
add_custom_command(
  OUTPUT ${java_sources}
  COMMAND ${LCM_GEN_EXECUTABLE} --java --jpath ${CMAKE_CURRENT_BINARY_DIR}/java ${type_files}
  DEPENDS ${type_files}
  COMMENT "Generating Java from the message definitions"
  VERBATIM)
# The classes run on Java 8 and newer. The path relative to the programs is the same as in an installation.
set(CMAKE_JAVA_COMPILE_FLAGS -encoding UTF-8 -Xlint:-options --release 8)
add_jar(
  buoyancy_java_types
  SOURCES ${java_sources}
  INCLUDE_JARS ${LCM_JAR}
  VERSION ${PROJECT_VERSION}
  OUTPUT_NAME buoyancy-lcmtypes
  OUTPUT_DIR ${CMAKE_BINARY_DIR}/share/java)
install_jar(buoyancy_java_types DESTINATION ${CMAKE_INSTALL_DATADIR}/java COMPONENT spy)
