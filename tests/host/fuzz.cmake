# libFuzzer, by clang: the fuzz targets over the shared library. PLM_FUZZ_SECONDS in the environment of ctest goes before
# the option (tests/run.sh --all: 60 in preset dev).
set(PLM_FUZZ_SECONDS 20 CACHE STRING "Seconds of fuzzing in the test host.fuzz")
option(PLM_FUZZ_INSTRUMENTED "host.fuzz follows the branches of the library, too: clang builds it once more, instrumented" OFF)
find_program(PLM_CLANG NAMES clang clang-14 clang-15 clang-16)
find_program(PLM_CLANGXX NAMES clang++ clang++-14 clang++-15 clang++-16)
set(PLM_CLANG_FUZZES FALSE)
if(PLM_CLANG AND PLM_CLANGXX)
    file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/try.c
         "int LLVMFuzzerTestOneInput(const unsigned char *d, unsigned long n) { (void)d, (void)n; return 0; }\n")
    execute_process(COMMAND ${PLM_CLANG} -fsanitize=fuzzer try.c -o try WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}
                    RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
    if(failed EQUAL 0)
        set(PLM_CLANG_FUZZES TRUE)
    endif()
endif()
if(PLM_SANITIZE)
    foreach(name fuzz fuzz_bytes)
        add_skipped_host_test(${name} "the sanitizer runtimes of clang and gcc do not mix")
    endforeach()
elseif(NOT PLM_CLANG_FUZZES)
    foreach(name fuzz fuzz_bytes)
        add_skipped_host_test(${name} "no clang with libFuzzer (Debian: clang, libclang-rt-dev)")
    endforeach()
else()
    set(fuzzed $<TARGET_FILE:plm>)
    if(PLM_FUZZ_INSTRUMENTED)
        set(build ${CMAKE_CURRENT_BINARY_DIR}/fuzz_library)
        set(fuzzed ${build}/src/libplm.so)
        # made with the other programs, not inside a test, which has a time limit
        add_custom_target(plm_fuzz_library ALL
                          COMMAND sh ${here}/fuzz_library.sh ${CMAKE_COMMAND} ${CMAKE_GENERATOR} ${PLM_CLANG} ${PLM_CLANGXX}
                                  ${PROJECT_SOURCE_DIR} ${build} -DPLM_WITH_CHOLMOD=${PLM_WITH_CHOLMOD} -DPLM_WITH_FFTW=${PLM_WITH_FFTW}
                                  -DPLM_WITH_TRANSIENT=${PLM_WITH_TRANSIENT} -DPLM_WITH_STUDY=${PLM_WITH_STUDY}
                          BYPRODUCTS ${fuzzed} COMMENT "The library for the fuzzer, by clang" VERBATIM)
        add_dependencies(plm_fuzz_library plm) # one after the other
    endif()
    add_host_test(fuzz sh ${here}/fuzz.sh ${PLM_CLANG} ${PROJECT_SOURCE_DIR}/include ${fuzzed}
                  ${CMAKE_CURRENT_BINARY_DIR}/fuzz ${PLM_FUZZ_SECONDS} fuzz 700)
    add_host_test(fuzz_bytes sh ${here}/fuzz.sh ${PLM_CLANG} ${PROJECT_SOURCE_DIR}/include ${fuzzed}
                  ${CMAKE_CURRENT_BINARY_DIR}/fuzz_bytes ${PLM_FUZZ_SECONDS} fuzz_bytes 20000 ${PROJECT_SOURCE_DIR}/tests/formats)
endif()
