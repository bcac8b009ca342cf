//! Signed distance, mass and inertia of the shapes of rigid objects.
