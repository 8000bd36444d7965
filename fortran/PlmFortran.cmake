# The Fortran interfaces compiled from source, as a host's compiler and flags need them. .mod files are good for one
# compiler and one set of flags only, hence:
#
#     plm_add_fortran(<target>)      static library with the module plm (and plm_c)
#     plm_add_fortran77(<target>)    static library with the FORTRAN 77 subroutines; the target's include folder has plmf.inc
#     plm_add_fortran_mpi(<target>)  static library with the module plm_mpi, for ranks of MPI; links to plm::fortran and plm::mpi
#
# The others link to plm::plm, or to PLM_FORTRAN_LINKS if that is set. All are compiled by CMAKE_Fortran_FLAGS.
set(PLM_FORTRAN_SOURCE_DIR ${CMAKE_CURRENT_LIST_DIR})
set(PLM_FORTRAN_MODULE_SOURCES plm_c.f90 plm_errors.f90 plm_context.f90 plm_keys.f90 plm_methods.f90
    plm_model.f90 plm_branch.f90 plm_reduction.f90 plm_response.f90 plm_motion.f90 plm_study.f90 plm_facts.f90 plm.f90)
set(PLM_FORTRAN_MODULE_INCLUDES plm_model_int64.inc plm_motion_int64.inc)
set(PLM_FORTRAN_77_SOURCES plm_c.f90 plm_f77.f90 plm_f77_calls.f90 plm_f77_keys.f90 plm_f77_bytes.f90)

function(plm_fortran_library target)
    list(TRANSFORM ARGN PREPEND ${PLM_FORTRAN_SOURCE_DIR}/)
    add_library(${target} STATIC ${ARGN})
    set(links plm::plm)
    if(PLM_FORTRAN_LINKS)
        set(links ${PLM_FORTRAN_LINKS})
    endif()
    target_link_libraries(${target} PUBLIC ${links})
    set(modules ${CMAKE_CURRENT_BINARY_DIR}/${target}_modules)
    set_target_properties(${target} PROPERTIES Fortran_MODULE_DIRECTORY ${modules} LINKER_LANGUAGE Fortran
                                               POSITION_INDEPENDENT_CODE ON)
    target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${modules}> $<BUILD_INTERFACE:${PLM_FORTRAN_SOURCE_DIR}>)
endfunction()

function(plm_add_fortran target)
    plm_fortran_library(${target} ${PLM_FORTRAN_MODULE_SOURCES})
endfunction()

function(plm_add_fortran77 target)
    plm_fortran_library(${target} ${PLM_FORTRAN_77_SOURCES})
endfunction()

function(plm_add_fortran_mpi target)
    set(PLM_FORTRAN_LINKS plm::fortran plm::mpi)
    plm_fortran_library(${target} plm_mpi_c.f90 plm_mpi.f90)
endfunction()
