# A shared object that carries its own ARPACK, FFTW, BLAS and LAPACK, hidden from the host: neither are its calls captured
# by routines of the same name in the host, nor the host's by those in here. CHOLMOD stays shared, since Debian's archive
# of it is not position-independent; it loads the system's BLAS and LAPACK for itself.
option(PLM_SELF_CONTAINED "Link ARPACK, FFTW and OpenBLAS as hidden archives into libplm.so" OFF)
if(NOT PLM_SELF_CONTAINED)
    return()
endif()

# plm_find_archive(<variable> <name> <Debian package>)
function(plm_find_archive variable name package)
    find_library(${variable} NAMES ${CMAKE_STATIC_LIBRARY_PREFIX}${name}${CMAKE_STATIC_LIBRARY_SUFFIX})
    if(NOT ${variable})
        message(FATAL_ERROR "PLM_SELF_CONTAINED needs the static lib${name} (Debian: ${package}); install it or configure "
                            "with -DPLM_SELF_CONTAINED=OFF")
    endif()
endfunction()

plm_find_archive(PLM_ARPACK_ARCHIVE arpack libarpack2-dev)
plm_find_archive(PLM_OPENBLAS_ARCHIVE openblas libopenblas-dev)
add_library(plm_carried INTERFACE)
target_link_libraries(plm_carried INTERFACE ${PLM_ARPACK_ARCHIVE})
if(PLM_WITH_FFTW)
    plm_find_archive(PLM_FFTW_ARCHIVE fftw3 libfftw3-dev)
    target_link_libraries(plm_carried INTERFACE ${PLM_FFTW_ARCHIVE})
endif()
# ARPACK and LAPACK are Fortran: their runtime is versioned and stays shared.
find_library(PLM_GFORTRAN_LIBRARY NAMES gfortran libgfortran.so.5 PATHS ${CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES} REQUIRED)
target_link_libraries(plm_carried INTERFACE ${PLM_OPENBLAS_ARCHIVE} ${PLM_GFORTRAN_LIBRARY} m)
target_link_options(plm_carried INTERFACE LINKER:--exclude-libs,ALL)
