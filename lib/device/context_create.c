/* skg_context_create: opens the best device that passes its self-test. */
#include "core/text.h"
#include "device/choice.h"
#include "device/self_tests.h"

#include <stdio.h>

skg_status skg_context_create(const char *config, skg_context **context) {
    SKG_PLAIN;
    SKG_NEEDS(context);
    *context = NULL;
    char refused[SKG_MAILBOX_SENTENCE] = "";
    uint64_t without = 0; /* bit n: not device n */
    for (;;) {
        skg_context *made = NULL;
        int32_t index = -1;
        skg_status status = skg_context_open(config, without, &made, &index);
        if (status == SKG_ERR_NO_DEVICE && refused[0]) return skg_fail(SKG_ERR_DEVICE, "%s", refused);
        if (status != SKG_OK && index < 0) return status; /* no device is at fault */
        if (status == SKG_OK) status = skg_self_test_need(made, SKG_SELF_TEST_CORE);
        if (status == SKG_OK) {
            if (refused[0]) skg_mailbox_put(skg_mailbox_address(made->driver), refused);
            *context = made;
            return SKG_OK;
        }
        skg_context_release(&made);
        if (status != SKG_ERR_DEVICE && status != SKG_ERR_BUILD) return status;
        snprintf(refused, sizeof refused, "%s", skg_last_error());
        without |= UINT64_C(1) << index;
    }
}
