# CHOLMOD, SCOTCH and FFTW from their static archives, as one object inside libplm.so and libplm.a. Only what libplm calls is
# taken, under names of our own (carried_...), so that it neither lends nor borrows symbols; and src/linalg/carried puts
# parts of our own in place of those that would start threads, print, read the environment, or end the process. SCOTCH
# does all of that, so that it is carried or left out.
option(PLM_CARRY "Carry CHOLMOD, SCOTCH and FFTW from their static archives; OFF: link the shared ones, without SCOTCH" ON)

# plm_find_archive(<variable> <name>): lib<name>.a, or nothing
function(plm_find_archive variable name)
    find_library(${variable} NAMES ${CMAKE_STATIC_LIBRARY_PREFIX}${name}${CMAKE_STATIC_LIBRARY_SUFFIX})
    mark_as_advanced(${variable})
endfunction()

# plm_find_archives(<variable> <name>...): all of them, or nothing
function(plm_find_archives variable)
    set(found)
    foreach(name ${ARGN})
        string(TOUPPER PLM_${name}_ARCHIVE one)
        plm_find_archive(${one} ${name})
        if(NOT ${one})
            message(STATUS "No static lib${name}: its shared library is linked")
            set(found)
            break()
        endif()
        list(APPEND found ${${one}})
    endforeach()
    set(${variable} "${found}" PARENT_SCOPE)
endfunction()

set(PLM_CARRIED_CHOLMOD)
set(PLM_CARRIED_FFTW)
set(PLM_CARRIED_SCOTCH)
set(plm_carried_names)
set(plm_carried_parts)
set(plm_scotch_names)
if(PLM_CARRY AND PLM_WITH_CHOLMOD)
    plm_find_archives(PLM_CARRIED_CHOLMOD cholmod amd colamd suitesparseconfig)
endif()
if(PLM_WITH_SCOTCH)
    if(PLM_CARRY)
        plm_find_archives(PLM_CARRIED_SCOTCH scotch)
    endif()
    if(NOT PLM_CARRIED_SCOTCH)
        message(FATAL_ERROR "PLM_WITH_SCOTCH needs PLM_CARRY=ON and the static libscotch (Debian: libscotch-dev); or "
                            "configure with -DPLM_WITH_SCOTCH=OFF")
    endif()
endif()
if(PLM_CARRY AND PLM_WITH_FFTW)
    plm_find_archives(PLM_CARRIED_FFTW fftw3)
endif()
if(PLM_CARRIED_CHOLMOD)
    foreach(name start finish analyze analyze_p factorize allocate_dense free_dense free_factor rcond solve2 version)
        list(APPEND plm_carried_names cholmod_l_${name})
    endforeach()
    list(APPEND plm_carried_parts cholmod_parts.cpp openmp_parts.cpp)
endif()
if(PLM_CARRIED_SCOTCH)
    foreach(name graphInit graphBuild graphOrder stratInit stratExit stratGraphOrderBuild randomReset version)
        list(APPEND plm_scotch_names SCOTCH_${name})
    endforeach()
    list(APPEND plm_carried_names ${plm_scotch_names})
endif()
if(PLM_CARRIED_FFTW)
    list(APPEND plm_carried_names fftw_plan_dft_r2c_1d fftw_plan_dft_c2r_1d fftw_destroy_plan fftw_execute fftw_version)
    list(APPEND plm_carried_parts fftw_parts.cpp)
    set(plm_carried_defined PLM_CARRIED_FFTW)
endif()

add_library(plm_dep_carried INTERFACE)
set(PLM_CARRIED_OBJECT)
if(NOT plm_carried_names)
    return()
endif()

# The names that libplm's own sources use become those of the object.
set(PLM_CARRIED_DEFINITIONS ${plm_carried_defined})
set(plm_new_names)
foreach(name ${plm_carried_names})
    list(APPEND PLM_CARRIED_DEFINITIONS ${name}=carried_${name})
    string(APPEND plm_new_names "${name} carried_${name}\n")
endforeach()

# plm_carry_parts(<target> <file of src/linalg/carried>...): our own parts, compiled
function(plm_carry_parts target)
    list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/src/linalg/carried/ OUTPUT_VARIABLE files)
    add_library(${target} OBJECT ${files})
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src)
    if(PLM_CARRIED_CHOLMOD)
        target_include_directories(${target} SYSTEM PRIVATE ${PLM_CHOLMOD_INCLUDE})
    endif()
    # nothing of a sanitizer's or a fuzzer's: these stand among functions that were compiled without
    if(PLM_SANITIZE)
        target_compile_options(${target} PRIVATE -fno-sanitize=all)
    endif()
endfunction()
set(plm_parts)
if(plm_carried_parts)
    plm_carry_parts(plm_carried_parts ${plm_carried_parts})
    list(APPEND plm_parts plm_carried_parts)
endif()
if(PLM_CARRIED_SCOTCH)
    plm_carry_parts(plm_scotch_parts scotch_parts.cpp)
    list(APPEND plm_parts plm_scotch_parts)
endif()

set(plm_carried_folder ${PROJECT_BINARY_DIR}/carried)
string(REPLACE ";" "\n" plm_kept "${plm_carried_names}")
file(WRITE ${plm_carried_folder}/kept "${plm_kept}\ncarried_fftw_may_work\ncarried_scotch_scans\ncarried_scotch_release\n")
file(WRITE ${plm_carried_folder}/renamed "${plm_new_names}")
# SCOTCH does not bear a malloc that fails: it gets one that throws, and that knows what is to be given back then.
set(plm_scotch)
if(PLM_CARRIED_SCOTCH)
    set(plm_scotch ${plm_carried_folder}/libscotch.a)
    add_custom_command(
        OUTPUT ${plm_scotch}
        COMMAND ${CMAKE_OBJCOPY} --redefine-sym malloc=carried_scotch_malloc --redefine-sym realloc=carried_scotch_realloc
                --redefine-sym free=carried_scotch_free ${PLM_CARRIED_SCOTCH} ${plm_scotch}
        DEPENDS ${PLM_CARRIED_SCOTCH} VERBATIM COMMENT "SCOTCH with the library's malloc")
    add_custom_target(plm_scotch_archive DEPENDS ${plm_scotch})
endif()

# plm_carry(<name> PARTS <target>... NAMES <function>... ARCHIVES <file>...): carried/<name>.o by the target plm_<name>_object
function(plm_carry name)
    cmake_parse_arguments(PARSE_ARGV 1 carry "" "" "PARTS;NAMES;ARCHIVES")
    set(all ${plm_carried_folder}/${name}_all.o)
    set(object ${plm_carried_folder}/${name}.o)
    set(parts)
    foreach(part ${carry_PARTS})
        list(APPEND parts $<TARGET_OBJECTS:${part}>)
    endforeach()
    list(TRANSFORM carry_NAMES PREPEND "-Wl,--undefined=")
    add_custom_command(
        OUTPUT ${object}
        COMMAND ${CMAKE_C_COMPILER} -r -nostdlib -Wl,--force-group-allocation -o ${all} ${parts} ${carry_NAMES} ${carry_ARCHIVES}
        COMMAND ${CMAKE_OBJCOPY} --keep-global-symbols=${plm_carried_folder}/kept ${all}
        COMMAND ${CMAKE_OBJCOPY} --redefine-syms=${plm_carried_folder}/renamed ${all} ${object}
        DEPENDS ${carry_PARTS} ${parts} ${carry_ARCHIVES} ${plm_carried_folder}/kept ${plm_carried_folder}/renamed
        COMMAND_EXPAND_LISTS VERBATIM
        COMMENT "Carrying CHOLMOD, SCOTCH and FFTW: ${name}")
    add_custom_target(plm_${name}_object DEPENDS ${object})
    if(TARGET plm_scotch_archive) # of all that need it one makes it
        add_dependencies(plm_${name}_object plm_scotch_archive)
    endif()
endfunction()
plm_carry(carried PARTS ${plm_parts} NAMES ${plm_carried_names} ARCHIVES ${PLM_CARRIED_CHOLMOD} ${plm_scotch} ${PLM_CARRIED_FFTW})
set(PLM_CARRIED_OBJECT ${plm_carried_folder}/carried.o)
target_link_libraries(plm_dep_carried INTERFACE ${PLM_CARRIED_OBJECT})
