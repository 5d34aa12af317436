# CPack runs this before it packs what has been installed into CPACK_TEMPORARY_DIRECTORY: `cmake --install` leaves out
# programs and texts that are not built, a package never does.
set(files share/bash-completion/completions/shaken share/zsh/vendor-completions/_shaken)
foreach(name IN LISTS CPACK_SHAKEN_PROGRAMS)
  list(APPEND files bin/${name} share/man/man1/${name}.1.gz)
endforeach()
foreach(file IN LISTS files)
  if(NOT EXISTS ${CPACK_TEMPORARY_DIRECTORY}/programs${CPACK_PACKAGING_INSTALL_PREFIX}/${file})
    message(FATAL_ERROR "The package would lack ${file}; `./dev package` builds all that belongs to it.")
  endif()
endforeach()
