# CPack runs this after it has copied the files of every package to CPACK_TEMPORARY_DIRECTORY/<component> and before it
# packs them. It applies what debhelper would.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result ERROR_VARIABLE error)
  if(result)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}: ${error}")
  endif()
endfunction()

set(packaging "${CPACK_BUOYANCY_SOURCE_DIR}/packaging")
set(programs "${CPACK_TEMPORARY_DIRECTORY}/programs")

file(MAKE_DIRECTORY "${programs}/etc/buoyancy")
file(COPY "${packaging}/scene.toml" DESTINATION "${programs}/etc/buoyancy")
# Units are below the prefix in a manual installation and in packages from Debian 13 on, but below the root in those of
# Debian 12.
file(STRINGS /etc/os-release debian_12 REGEX "^VERSION_ID=\"?12\"?$")
if(debian_12 AND EXISTS "${programs}/usr/lib/systemd")
  file(MAKE_DIRECTORY "${programs}/lib")
  file(RENAME "${programs}/usr/lib/systemd" "${programs}/lib/systemd")
endif()
file(GLOB units "${programs}/lib/systemd/system/*.service" "${programs}/usr/lib/systemd/system/*.service")
foreach(unit IN LISTS units)
  file(STRINGS "${unit}" commands REGEX "^Exec[A-Za-z]*=")
  foreach(command IN LISTS commands)
    if(command MATCHES "^[^=]*=[-@:+!]*\"?(/[^\" ]*buoyancy[^\" ]*)" AND NOT EXISTS "${programs}${CMAKE_MATCH_1}")
      message(FATAL_ERROR "${unit}: ${command}: the package does not contain ${CMAKE_MATCH_1}. Was the unit generated "
                          "for a prefix other than CPACK_INSTALL_PREFIX?")
    endif()
  endforeach()
endforeach()

foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  set(root "${CPACK_TEMPORARY_DIRECTORY}/${component}")
  string(TOUPPER ${component} upper)
  set(package ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})

  set(doc "${root}/usr/share/doc/${package}")
  file(MAKE_DIRECTORY "${doc}")
  file(COPY "${packaging}/copyright" DESTINATION "${doc}")
  configure_file("${packaging}/changelog" "${doc}/changelog.Debian" COPYONLY)
  configure_file("${CPACK_BUOYANCY_SOURCE_DIR}/CHANGELOG.md" "${doc}/changelog" COPYONLY)
  file(GLOB_RECURSE pages "${root}/usr/share/man/*")
  run(gzip -9n "${doc}/changelog.Debian" "${doc}/changelog" ${pages})

  # The package is not uploaded to Debian, so that there is no bug that it could close.
  file(WRITE "${root}/usr/share/lintian/overrides/${package}"
       "# Not uploaded to Debian, so that there is no bug to close.\n${package}: initial-upload-closes-no-bugs *\n")

  file(GLOB binaries "${root}/usr/bin/*" "${root}/usr/libexec/buoyancy/*")
  foreach(binary IN LISTS binaries)
    file(READ "${binary}" magic LIMIT 4 HEX)
    if(magic STREQUAL "7f454c46")  # ELF; other files are scripts
      run(strip --remove-section=.comment --remove-section=.note "${binary}")
    endif()
  endforeach()
  file(GLOB_RECURSE modules "${root}/usr/lib/python3/*.so")
  if(modules)
    run(strip --strip-unneeded --remove-section=.comment --remove-section=.note ${modules})
  endif()
  # The link to a library, which the development package has, is left alone.
  file(GLOB_RECURSE libraries "${root}/usr/lib/*.so.*")
  if(libraries)
    run(strip --strip-unneeded --remove-section=.comment --remove-section=.note ${libraries})
  endif()
  if(component STREQUAL "c_library")
    # dpkg-shlibdeps reads a control file and prints "shlibs:Depends=...".
    set(work "${CPACK_TEMPORARY_DIRECTORY}/shlibdeps")
    file(WRITE "${work}/debian/control" "Source: buoyancy\n\nPackage: ${package}\nArchitecture: any\n")
    execute_process(COMMAND dpkg-shlibdeps -O ${libraries} WORKING_DIRECTORY "${work}" OUTPUT_VARIABLE depends
                    ERROR_VARIABLE error RESULT_VARIABLE result OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(result)
      message(FATAL_ERROR "dpkg-shlibdeps: ${error}")
    endif()
    string(REGEX REPLACE "^shlibs:Depends=" "" depends "${depends}")
    string(PREPEND depends "${CPACK_DEBIAN_C_LIBRARY_PACKAGE_DEPENDS}, ")
    set(CPACK_DEBIAN_C_LIBRARY_PACKAGE_DEPENDS "${depends}")
    file(REMOVE_RECURSE "${work}")
  endif()
  file(GLOB_RECURSE archives "${root}/usr/lib/*.a")
  if(archives)
    run(strip --strip-debug --remove-section=.comment --remove-section=.note --enable-deterministic-archives
        ${archives})
  endif()
  run(find "${root}" -type f -not -path "*/usr/bin/*" -not -path "*/usr/libexec/*" -exec chmod 644 {} +)
  run(find "${root}" -type d -empty -delete)
  run(find "${root}" -type d -exec chmod 755 {} +)
endforeach()
