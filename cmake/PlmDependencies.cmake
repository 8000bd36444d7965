# The libraries underneath, each as one interface target plm_dep_<name>.
find_package(BLAS REQUIRED)
find_package(LAPACK REQUIRED)
find_package(Threads REQUIRED)

add_library(plm_dep_lapack INTERFACE)
target_link_libraries(plm_dep_lapack INTERFACE LAPACK::LAPACK BLAS::BLAS)

find_library(PLM_ARPACK_LIBRARY NAMES arpack REQUIRED)
add_library(plm_dep_arpack INTERFACE)
target_link_libraries(plm_dep_arpack INTERFACE ${PLM_ARPACK_LIBRARY})

add_library(plm_dep_cholmod INTERFACE)
add_library(plm_dep_eigen INTERFACE)
if(PLM_WITH_CHOLMOD)
    find_path(PLM_CHOLMOD_INCLUDE cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
    find_library(PLM_CHOLMOD_LIBRARY NAMES cholmod REQUIRED)
    target_include_directories(plm_dep_cholmod SYSTEM INTERFACE ${PLM_CHOLMOD_INCLUDE})
    target_link_libraries(plm_dep_cholmod INTERFACE ${PLM_CHOLMOD_LIBRARY})
else()
    find_path(PLM_EIGEN_INCLUDE Eigen/SparseCholesky PATH_SUFFIXES eigen3 REQUIRED)
    target_include_directories(plm_dep_eigen SYSTEM INTERFACE ${PLM_EIGEN_INCLUDE})
endif()

add_library(plm_dep_fftw INTERFACE)
if(PLM_WITH_FFTW)
    find_path(PLM_FFTW_INCLUDE fftw3.h REQUIRED)
    find_library(PLM_FFTW_LIBRARY NAMES fftw3 REQUIRED)
    target_include_directories(plm_dep_fftw SYSTEM INTERFACE ${PLM_FFTW_INCLUDE})
    target_link_libraries(plm_dep_fftw INTERFACE ${PLM_FFTW_LIBRARY})
endif()

include(PlmSelfContained)

if(PLM_BUILD_TESTS)
    find_package(PkgConfig REQUIRED)
    pkg_check_modules(cmocka REQUIRED IMPORTED_TARGET cmocka)
endif()
