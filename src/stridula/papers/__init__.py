"""Papers reproduced, claim by claim."""
