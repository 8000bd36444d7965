# PLM_PYTHON: a Python that has NumPy and SciPy (the first one in PATH may have none); empty when there is none.
# PLM_PYTHON_ENVIRONMENT: what it needs to use the package in place with the library of this build.
if(NOT PLM_PYTHON)
    foreach(candidate ${Python3_EXECUTABLE} python3 /usr/bin/python3)
        find_program(PLM_PYTHON_CANDIDATE ${candidate} NO_CACHE)
        if(PLM_PYTHON_CANDIDATE)
            execute_process(COMMAND ${PLM_PYTHON_CANDIDATE} -c "import numpy, scipy.sparse" RESULT_VARIABLE failed
                            OUTPUT_QUIET ERROR_QUIET)
            if(failed EQUAL 0)
                set(PLM_PYTHON ${PLM_PYTHON_CANDIDATE} CACHE FILEPATH "Python with NumPy and SciPy for the tests of the package")
                break()
            endif()
        endif()
        unset(PLM_PYTHON_CANDIDATE)
    endforeach()
endif()
set(PLM_PYTHON_ENVIRONMENT PLM_LIBRARY=$<TARGET_FILE:plm> PYTHONPATH=${PROJECT_SOURCE_DIR}/bindings/python
                           PYTHONDONTWRITEBYTECODE=1 MPLBACKEND=Agg MPLCONFIGDIR=${PROJECT_BINARY_DIR}/matplotlib)
if(PLM_SANITIZE)
    # The interpreter is not built with the sanitizers, so they are loaded before it, and with them the C++ library, whose
    # throw they wrap. Python and NumPy keep memory until the end: no search for leaks.
    set(runtime libasan.so)
    if(CMAKE_CXX_COMPILER_ID STREQUAL Clang)
        set(runtime libclang_rt.asan-${CMAKE_SYSTEM_PROCESSOR}.so)
    endif()
    foreach(library ${runtime} libstdc++.so.6)
        execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=${library} OUTPUT_VARIABLE found
                        OUTPUT_STRIP_TRAILING_WHITESPACE)
        list(APPEND preload ${found})
    endforeach()
    list(JOIN preload ":" preload)
    list(APPEND PLM_PYTHON_ENVIRONMENT LD_PRELOAD=${preload} ASAN_OPTIONS=detect_leaks=0)
endif()
