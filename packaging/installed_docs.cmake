# Installs the pages of docs with README.md as their index. An installation has no source tree: links to the scenes lead
# to the installed ones, and of links to other files of the tree the words remain.
file(GLOB pages CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/*.md)
set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${pages})
file(RELATIVE_PATH scenes ${CMAKE_INSTALL_FULL_DOCDIR} ${CMAKE_INSTALL_FULL_DATADIR}/buoyancy/scenes)
foreach(page IN LISTS pages)
  file(READ ${page} text)
  string(REPLACE "](../scenes/" "](${scenes}/" text "${text}")
  string(REGEX REPLACE "\\[([^]]*)\\]\\((\\.\\./[a-zA-Z][^)]*|man)\\)" "\\1" text "${text}")
  get_filename_component(name ${page} NAME)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/installed_docs/${name} CONTENT "${text}" @ONLY)
endforeach()
install(DIRECTORY ${CMAKE_BINARY_DIR}/installed_docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.md")
install(DIRECTORY docs/figures DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.png" PATTERN "*.svg")
