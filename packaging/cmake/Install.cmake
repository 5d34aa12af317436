# What `cmake --install` puts where, and the Debian packages that `./dev package` makes of it by CPack. Component
# "programs": the programs, their man pages, completions and scenes. Component "python": the Python package, which draws
# their plots. Component "libraries": the simulator and the observables, for programs of one's own (find_package(shaken)).
# Component "docs": the site of the pages, if `./dev docs` has made it there.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

if(NOT SHAKEN_ONLY_SIM)
  set(SHAKEN_PROGRAMS shaken shakend shaken-worker shaken-task shaken-web)
  foreach(part render bench)
    string(TOUPPER ${part} PART)
    if(SHAKEN_${PART})
      list(APPEND SHAKEN_PROGRAMS shaken-${part})
    endif()
  endforeach()
  # what is not built is left out (packaging/cmake/whole_package.cmake holds packages to all of it)
  install(TARGETS ${SHAKEN_PROGRAMS} COMPONENT programs OPTIONAL)
  foreach(program shaken-worker shaken-bench)
    if(TARGET ${program}-wide)
      install(TARGETS ${program}-wide COMPONENT programs OPTIONAL)
    else()  # that of a former installation has another simulator
      install(CODE "file(REMOVE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/bin/${program}-wide\")" COMPONENT programs)
    endif()
  endforeach()
  install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DATADIR}/shaken COMPONENT programs PATTERN tests EXCLUDE)
  install(DIRECTORY web/page DESTINATION ${CMAKE_INSTALL_DATADIR}/shaken COMPONENT programs)
  install(DIRECTORY ${CMAKE_BINARY_DIR}/share/shaken/schemas DESTINATION ${CMAKE_INSTALL_DATADIR}/shaken COMPONENT programs)
  # the Python package: where the programs look for it, and by a link where Debian's Python does
  install(DIRECTORY python/shaken DESTINATION ${CMAKE_INSTALL_DATADIR}/shaken/python COMPONENT python
    FILES_MATCHING PATTERN *.py PATTERN *.json PATTERN py.typed PATTERN __pycache__ EXCLUDE)
  if(SHAKEN_PYTHON)  # for one kind of machine and of Python: not below share
    install(TARGETS shaken_native LIBRARY DESTINATION lib/shaken COMPONENT python OPTIONAL)
  endif()
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/dist-packages)
  file(CREATE_LINK ../../../${CMAKE_INSTALL_DATADIR}/shaken/python/shaken ${CMAKE_BINARY_DIR}/dist-packages/shaken SYMBOLIC)
  install(FILES ${CMAKE_BINARY_DIR}/dist-packages/shaken DESTINATION lib/python3/dist-packages COMPONENT python)
  install(DIRECTORY proto/ DESTINATION ${CMAKE_INSTALL_DATADIR}/shaken/lcm COMPONENT programs FILES_MATCHING PATTERN *.lcm)
  # not below CMAKE_INSTALL_LIBDIR, which names the machine
  install(FILES packaging/systemd/shakend.service DESTINATION lib/systemd/user COMPONENT programs)
  install(FILES packaging/systemd/shakend@.service DESTINATION lib/systemd/system COMPONENT programs)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT programs RENAME copyright)
  install(FILES README.md CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT programs)
  install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT programs PATTERN archive EXCLUDE)
  install(DIRECTORY ${CMAKE_BINARY_DIR}/site/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/html COMPONENT docs OPTIONAL
    PATTERN .doctrees EXCLUDE PATTERN .buildinfo EXCLUDE)

  # man pages and completions are made by the programs themselves, so only where they can run and help2man is there
  set(SHAKEN_TEXTS ${CMAKE_BINARY_DIR}/texts)
  add_custom_target(texts
    COMMAND ${CMAKE_SOURCE_DIR}/packaging/cmake/package_texts ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${SHAKEN_TEXTS}
    DEPENDS ${SHAKEN_PROGRAMS}
    COMMENT "Writing man pages and completions")
  install(DIRECTORY ${SHAKEN_TEXTS}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT programs OPTIONAL)
  install(DIRECTORY ${SHAKEN_TEXTS}/bash/ DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
    COMPONENT programs OPTIONAL)
  install(DIRECTORY ${SHAKEN_TEXTS}/zsh/ DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions
    COMPONENT programs OPTIONAL)

  set(SHAKEN_LIBRARIES shaken_options shaken_core shaken_sim shaken_analysis)
  foreach(library IN LISTS SHAKEN_LIBRARIES)
    string(REPLACE shaken_ "" name ${library})
    set_target_properties(${library} PROPERTIES EXPORT_NAME ${name})
  endforeach()
  install(TARGETS ${SHAKEN_LIBRARIES} EXPORT shaken COMPONENT libraries)
  install(FILES base/estimate.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/shaken/base COMPONENT libraries)
  install(DIRECTORY base/core DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/shaken/base COMPONENT libraries
    FILES_MATCHING PATTERN *.h)
  install(DIRECTORY sim analysis DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/shaken COMPONENT libraries
    FILES_MATCHING PATTERN *.h)
  set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/shaken)
  install(EXPORT shaken NAMESPACE shaken:: FILE targets.cmake DESTINATION ${package_dir} COMPONENT libraries)
  configure_package_config_file(packaging/cmake/shaken-config.cmake.in ${CMAKE_BINARY_DIR}/shaken-config.cmake
    INSTALL_DESTINATION ${package_dir})
  write_basic_package_version_file(${CMAKE_BINARY_DIR}/shaken-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_BINARY_DIR}/shaken-config.cmake ${CMAKE_BINARY_DIR}/shaken-config-version.cmake
    DESTINATION ${package_dir} COMPONENT libraries)

  set(CPACK_GENERATOR DEB)
  set(CPACK_SHAKEN_PROGRAMS ${SHAKEN_PROGRAMS})
  set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/packaging/cmake/whole_package.cmake)
  set(CPACK_PACKAGE_CONTACT "The Shaken developers <shaken@localhost>")
  set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
  set(CPACK_COMPONENTS_ALL programs libraries python docs)
  set(CPACK_DEB_COMPONENT_INSTALL ON)
  set(CPACK_STRIP_FILES ON)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME shaken)
  set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS "ffmpeg")
  set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "python3-shaken, fonts-dejavu-core, libjs-chart.js")
  set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS "shaken-doc")
  set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION
    "Simulates rods between two vibrating plates in three dimensions, every collision\nresolved by an impulse: a daemon that runs sweeps, a command line, films and\npictures, live state over LCM.")
  set(CPACK_DEBIAN_LIBRARIES_PACKAGE_NAME libshaken-dev)
  set(CPACK_DEBIAN_LIBRARIES_PACKAGE_SECTION libdevel)
  set(CPACK_DEBIAN_LIBRARIES_PACKAGE_DEPENDS "libeigen3-dev, libxxhash-dev")
  set(CPACK_COMPONENT_LIBRARIES_DESCRIPTION
    "The simulator and the observables of Shaken as static libraries with headers,\nfound by CMake's find_package(shaken).")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-shaken)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3-numpy, python3-scipy, python3-matplotlib, \
python3-h5py, libxxhash0")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-gsd, python3-pandas")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION
    "Results of Shaken in Python: runs with their errors, sweeps, recorded frames, live\nstate of running jobs, plots, and the figures of the paper.")
  set(CPACK_DEBIAN_DOCS_PACKAGE_NAME shaken-doc)
  set(CPACK_DEBIAN_DOCS_PACKAGE_SECTION doc)
  set(CPACK_DEBIAN_DOCS_PACKAGE_ARCHITECTURE all)
  set(CPACK_COMPONENT_DOCS_DESCRIPTION
    "The pages of Shaken as a site to search, with every key of a scene, observable and\nfunction of the Python package: /usr/share/doc/shaken/html/index.html.")
  include(CPack)
endif()
