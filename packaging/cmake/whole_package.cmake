# CPack runs this before it packs what has been installed into CPACK_TEMPORARY_DIRECTORY, a folder for each component:
# `cmake --install` leaves out programs and texts that are not built, a package never does.
set(files share/bash-completion/completions/shaken share/zsh/vendor-completions/_shaken)
foreach(name IN LISTS CPACK_SHAKEN_PROGRAMS)
  list(APPEND files bin/${name} share/man/man1/${name}.1.gz)
endforeach()
foreach(file IN LISTS files ITEMS share/doc/shaken/html/index.html)
  file(GLOB found ${CPACK_TEMPORARY_DIRECTORY}/*${CPACK_PACKAGING_INSTALL_PREFIX}/${file})
  if(NOT found)
    message(FATAL_ERROR "The package would lack ${file}; `./dev package` builds all that belongs to it.")
  endif()
endforeach()
