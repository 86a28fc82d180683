/* `devices --test`: every device, with all kernels. */
#ifndef SKG_CLI_DEVICE_TESTS_H
#define SKG_CLI_DEVICE_TESTS_H

/* Tests and prints a table, or with json an object. Returns an exit status. */
int cli_device_tests(int json);

#endif
