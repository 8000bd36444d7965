# libFuzzer, by clang: the fuzz targets over the shared library. In preset asan, which clang builds, it follows the branches of
# the library, too, and AddressSanitizer watches its memory. PLM_FUZZ_SECONDS in the environment of ctest goes before the
# option (tests/run.sh --all: 30 in preset asan).
set(PLM_FUZZ_SECONDS 20 CACHE STRING "Seconds of fuzzing in the test host.fuzz")
find_program(PLM_CLANG NAMES clang clang-14 clang-15 clang-16)
set(PLM_CLANG_FUZZES FALSE)
if(PLM_CLANG)
    file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/try.c
         "int LLVMFuzzerTestOneInput(const unsigned char *d, unsigned long n) { (void)d, (void)n; return 0; }\n")
    execute_process(COMMAND ${PLM_CLANG} -fsanitize=fuzzer try.c -o try WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}
                    RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
    if(failed EQUAL 0)
        set(PLM_CLANG_FUZZES TRUE)
    endif()
endif()
if(PLM_SANITIZE AND NOT (PLM_SANITIZE MATCHES fuzzer AND CMAKE_CXX_COMPILER_ID STREQUAL Clang))
    foreach(name fuzz fuzz_bytes)
        add_skipped_host_test(${name} "the sanitizer runtimes of clang and gcc do not mix")
    endforeach()
elseif(NOT PLM_CLANG_FUZZES)
    foreach(name fuzz fuzz_bytes)
        add_skipped_host_test(${name} "no clang with libFuzzer (Debian: clang, libclang-rt-dev)")
    endforeach()
else()
    add_host_test(fuzz sh ${here}/fuzz.sh ${PLM_CLANG} ${PROJECT_SOURCE_DIR}/include $<TARGET_FILE:plm>
                  ${CMAKE_CURRENT_BINARY_DIR}/fuzz ${PLM_FUZZ_SECONDS} fuzz 700)
    add_host_test(fuzz_bytes sh ${here}/fuzz.sh ${PLM_CLANG} ${PROJECT_SOURCE_DIR}/include $<TARGET_FILE:plm>
                  ${CMAKE_CURRENT_BINARY_DIR}/fuzz_bytes ${PLM_FUZZ_SECONDS} fuzz_bytes 20000 ${PROJECT_SOURCE_DIR}/tests/formats)
endif()
