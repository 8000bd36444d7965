# A shared object that carries its own ARPACK, BLAS and LAPACK, too, hidden from the host: neither are its calls captured
# by routines of the same name in the host, nor the host's by those in here.
option(PLM_SELF_CONTAINED "libplm.so carries an ARPACK and an OpenBLAS of its own, too, and borrows nothing from its host" OFF)
if(NOT PLM_SELF_CONTAINED)
    return()
endif()

if(PLM_WITH_CHOLMOD AND NOT PLM_CARRIED_CHOLMOD)
    message(FATAL_ERROR "PLM_SELF_CONTAINED needs PLM_CARRY=ON and the static libraries cholmod, amd, colamd and "
                        "suitesparseconfig (Debian: libsuitesparse-dev): a shared CHOLMOD calls the host's BLAS. Or configure "
                        "with -DPLM_SELF_CONTAINED=OFF or -DPLM_WITH_CHOLMOD=OFF")
endif()
if(PLM_WITH_FFTW AND NOT PLM_CARRIED_FFTW)
    message(FATAL_ERROR "PLM_SELF_CONTAINED needs PLM_CARRY=ON and the static libfftw3 (Debian: libfftw3-dev); or configure "
                        "with -DPLM_SELF_CONTAINED=OFF or -DPLM_WITH_FFTW=OFF")
endif()

# Debian's serial one first: the others start threads when they are loaded, even if they then work on one.
set(plm_openblas ${CMAKE_STATIC_LIBRARY_PREFIX}openblas${CMAKE_STATIC_LIBRARY_SUFFIX})
find_library(PLM_OPENBLAS_ARCHIVE NAMES ${plm_openblas} PATH_SUFFIXES openblas-serial)
if(NOT PLM_OPENBLAS_ARCHIVE)
    message(FATAL_ERROR "PLM_SELF_CONTAINED needs the static libopenblas (Debian: libopenblas-serial-dev); install it or "
                        "configure with -DPLM_SELF_CONTAINED=OFF")
endif()
plm_find_archive(PLM_ARPACK_ARCHIVE arpack)
if(NOT PLM_ARPACK_ARCHIVE)
    message(FATAL_ERROR "PLM_SELF_CONTAINED needs the static libarpack (Debian: libarpack2-dev); install it or configure with "
                        "-DPLM_SELF_CONTAINED=OFF")
endif()
add_library(plm_own_blas INTERFACE)
target_link_libraries(plm_own_blas INTERFACE ${PLM_ARPACK_ARCHIVE})

# Its kernels for small products take what malloc gives without a look: they get a malloc that gives. Its table of work
# buffers gets the lock that a build without threads lacks.
add_library(plm_blas_parts OBJECT ${PROJECT_SOURCE_DIR}/src/linalg/carried/blas_parts.cpp)
target_include_directories(plm_blas_parts PRIVATE ${PROJECT_SOURCE_DIR}/src)
set(PLM_BLAS_KERNELS ${PROJECT_BINARY_DIR}/carried/blas_kernels.o)
add_custom_command(
    OUTPUT ${PLM_BLAS_KERNELS}
    COMMAND sh ${PROJECT_SOURCE_DIR}/cmake/blas_kernels.sh ${CMAKE_C_COMPILER} ${CMAKE_AR} ${CMAKE_OBJCOPY}
            ${PLM_OPENBLAS_ARCHIVE} ${PLM_BLAS_KERNELS}
    DEPENDS ${PROJECT_SOURCE_DIR}/cmake/blas_kernels.sh ${PLM_OPENBLAS_ARCHIVE}
    VERBATIM COMMENT "OpenBLAS's kernels for small products")
add_custom_target(plm_blas_kernels DEPENDS ${PLM_BLAS_KERNELS})
# ARPACK and LAPACK are Fortran: their runtime is versioned and stays shared.
find_library(PLM_GFORTRAN_LIBRARY NAMES gfortran libgfortran.so.5 PATHS ${CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES} REQUIRED)
target_link_libraries(plm_own_blas INTERFACE ${PLM_OPENBLAS_ARCHIVE} ${PLM_GFORTRAN_LIBRARY} m)
target_link_options(plm_own_blas INTERFACE LINKER:--exclude-libs,ALL LINKER:--wrap=blas_memory_alloc)
