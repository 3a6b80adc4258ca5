"""Step 5 for one contact: friction, unilateral contact, stiffness, in the plane and in space."""
